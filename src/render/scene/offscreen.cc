#include "render/scene/offscreen.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace patrol::render {

Offscreen::Offscreen(const mjModel& model, int width, int height, Renderer renderer)
    : gl_(make_gl_context(renderer)), viewport_{0, 0, width, height} {
  if (width < 1 || height < 1)
    throw std::runtime_error(fmt::format("frame size {}x{}: must be at least 1x1", width, height));
  gl_->make_current();
  mjr_defaultContext(&context_);
  mjr_makeContext(&model, &context_, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  // Recreates the buffer without multisampling: a multisampled depth is not that of the pixel's center, and
  // multisampling takes most of a frame's time.
  context_.offSamples = 0;
  mjr_resizeOffscreen(width + 1, height + 1, &context_);
  mjr_resizeOffscreen(width, height, &context_);
  const mjrRect largest = mjr_maxViewport(&context_);
  if (context_.currentBuffer != mjFB_OFFSCREEN || largest.width < width || largest.height < height) {
    mjr_freeContext(&context_);
    throw std::runtime_error(fmt::format("OpenGL: cannot create an off-screen buffer of {}x{}", width, height));
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
