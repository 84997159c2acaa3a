#include "render/offscreen.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include <GL/osmesa.h>
#include <fmt/format.h>

namespace patrol::render {

/// MuJoCo draws into a frame buffer object of its own; the buffer that OSMesa asks for is only there to be
/// asked for.
struct Offscreen::GlContext {
  static constexpr int kSize = 16;

  GlContext() : context(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr)) {
    if (context == nullptr) throw std::runtime_error("OSMesa gives no OpenGL context");
  }
  ~GlContext() { OSMesaDestroyContext(context); }
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  void make_current() {
    if (OSMesaMakeCurrent(context, window.data(), GL_UNSIGNED_BYTE, kSize, kSize) != GL_TRUE) {
      throw std::runtime_error("OSMesa does not let its OpenGL context be used");
    }
  }

  OSMesaContext context;
  std::array<unsigned char, 4 * kSize * kSize> window{};
};

Offscreen::Offscreen(const mjModel& model, int width, int height)
    : gl_(std::make_unique<GlContext>()), viewport_{0, 0, width, height} {
  if (width < 1 || height < 1)
    throw std::runtime_error(fmt::format("a frame of {}x{} has no pixels", width, height));
  gl_->make_current();
  mjr_defaultContext(&context_);
  mjr_makeContext(&model, &context_, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  // Made anew without multisampling, whose depth is that of a sample off the pixel's centre, and which costs
  // most of a frame.
  context_.offSamples = 0;
  mjr_resizeOffscreen(width + 1, height + 1, &context_);
  mjr_resizeOffscreen(width, height, &context_);
  const mjrRect largest = mjr_maxViewport(&context_);
  if (context_.currentBuffer != mjFB_OFFSCREEN || largest.width < width || largest.height < height) {
    mjr_freeContext(&context_);
    throw std::runtime_error(fmt::format("OpenGL gives no off-screen buffer of {}x{}", width, height));
  }
}

Offscreen::~Offscreen() {
  gl_->make_current();
  mjr_freeContext(&context_);
}

void Offscreen::make_current() { gl_->make_current(); }

void Offscreen::render(mjvScene& scene) { mjr_render(viewport_, &scene, &context_); }

void Offscreen::read(Frame& frame) {
  if (frame.width() != width() || frame.height() != height()) frame = Frame(width(), height());
  mjr_readPixels(frame.bytes(), nullptr, viewport_, &context_);
  for (int top = 0, bottom = height() - 1; top < bottom; ++top, --bottom) {
    std::swap_ranges(&frame.at(0, top), &frame.at(0, top) + width(), &frame.at(0, bottom));
  }
}

void Offscreen::read_depth(std::vector<float>& depth) {
  const auto row = static_cast<std::size_t>(width());
  depth.resize(row * static_cast<std::size_t>(height()));
  mjr_readPixels(nullptr, depth.data(), viewport_, &context_);
  for (std::size_t top = 0, bottom = depth.size() - row; top < bottom; top += row, bottom -= row) {
    const auto upper = depth.begin() + static_cast<std::ptrdiff_t>(top);
    const auto lower = depth.begin() + static_cast<std::ptrdiff_t>(bottom);
    std::swap_ranges(upper, upper + static_cast<std::ptrdiff_t>(row), lower);
  }
}

}  // namespace patrol::render
