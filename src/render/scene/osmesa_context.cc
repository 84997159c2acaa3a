#include <array>
#include <stdexcept>
#include <string>

#include <GL/osmesa.h>

#include "core/shared_library.h"
#include "render/scene/gl_context.h"

namespace patrol::render {
namespace {

/// OSMesa library. MuJoCo searches its functions in the whole process.
class OsmesaLibrary {
 public:
  OsmesaLibrary() {
    if (!library_.is_loaded()) throw std::runtime_error("OSMesa: " + library_.error());
  }
  template <typename Function>
  Function* function(const char* name) const {
    void* const found = library_.find(name);
    if (found == nullptr) throw std::runtime_error(std::string("OSMesa: has no function ") + name);
    return reinterpret_cast<Function*>(found);
  }

 private:
  SharedLibrary library_{PATROL_OSMESA, SharedLibrary::Scope::kGlobal};
};

/// OSMesa context with a small dummy buffer. OSMesa requires a buffer, but MuJoCo renders into its own frame buffer
/// object.
class OsmesaContext : public GlContext {
 public:
  OsmesaContext()
      : make_current_(osmesa_.function<decltype(OSMesaMakeCurrent)>("OSMesaMakeCurrent")),
        destroy_(osmesa_.function<decltype(OSMesaDestroyContext)>("OSMesaDestroyContext")),
        context_(osmesa_.function<decltype(OSMesaCreateContextExt)>("OSMesaCreateContextExt")(OSMESA_RGBA, 24, 8, 0,
                                                                                              nullptr)) {
    if (context_ == nullptr) throw std::runtime_error("OSMesa: cannot create an OpenGL context");
  }
  ~OsmesaContext() override { destroy_(context_); }
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  void make_current() override {
    if (make_current_(context_, window_.data(), GL_UNSIGNED_BYTE, kSize, kSize) != GL_TRUE) {
      throw std::runtime_error("OSMesa: cannot make the OpenGL context current");
    }
  }

 private:
  static constexpr int kSize = 16;

  OsmesaLibrary osmesa_;
  decltype(&OSMesaMakeCurrent) make_current_;
  decltype(&OSMesaDestroyContext) destroy_;
  OSMesaContext context_;
  std::array<unsigned char, 4 * kSize * kSize> window_{};
};

}  // namespace

std::unique_ptr<GlContext> make_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace patrol::render
