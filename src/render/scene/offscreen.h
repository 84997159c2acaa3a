#pragma once

#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "render/scene/frame.h"
#include "render/scene/gl_context.h"

namespace patrol::render {

/// MuJoCo's renderer, drawing into memory without a display, and without a graphics card unless one is requested. May
/// be used only in the thread that created it. Two instances in one thread alternate by `make_current`.
class Offscreen {
 public:
  /// Uploads the model's textures and meshes; `model` is not needed afterwards. Throws std::runtime_error when OpenGL
  /// is not usable or the size exceeds its limits. Renders one sample per pixel, at its center, whatever the model
  /// requests.
  Offscreen(const mjModel& model, int width, int height, Renderer renderer = software_renderer());
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  int width() const { return viewport_.width; }
  int height() const { return viewport_.height; }
  mjrContext& context() { return context_; }

  void make_current();
  /// Draws the scene into the off-screen buffer.
  void render(mjvScene& scene);
  void read(Frame& frame);
  /// Reads the depth buffer, row 0 at the top: 0 at the near plane, 1 at the far plane (OpenGL's nonlinear depth).
  void read_depth(std::vector<float>& depth);

 private:
  std::unique_ptr<GlContext> gl_;
  mjrContext context_{};
  mjrRect viewport_;
};

}  // namespace patrol::render
