#include <array>
#include <stdexcept>

#include <GL/osmesa.h>

#include "render/scene/gl_context.h"

namespace patrol::render {
namespace {

/// OSMesa context with a small dummy buffer. OSMesa requires a buffer, but MuJoCo renders into its own frame buffer
/// object.
class OsmesaContext : public GlContext {
 public:
  OsmesaContext() : context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context_ == nullptr) throw std::runtime_error("OSMesa: cannot create an OpenGL context");
  }
  ~OsmesaContext() override { OSMesaDestroyContext(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, kSize, kSize) != GL_TRUE) {
      throw std::runtime_error("OSMesa: cannot make the OpenGL context current");
    }
  }

 private:
  static constexpr int kSize = 16;

  OSMesaContext context_;
  std::array<unsigned char, 4 * kSize * kSize> window_{};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace patrol::render
