#pragma once

#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "render/frame.h"
#include "render/gl_context.h"

namespace patrol::render {

/// MuJoCo's own renderer drawing into memory: no display, and no graphics card unless one is asked for. It belongs
/// to the thread that made it; two of them in one thread take turns by `make_current`.
class Offscreen {
 public:
  /// Uploads the model's textures and meshes; `model` is not needed afterwards. Throws std::runtime_error
  /// when there is no usable OpenGL, or when the size is more than it can do. One sample a pixel, at its
  /// centre, whatever the model asks for.
  Offscreen(const mjModel& model, int width, int height, Renderer renderer = software_renderer());
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  int width() const { return viewport_.width; }
  int height() const { return viewport_.height; }
  mjrContext& context() { return context_; }

  void make_current();
  /// Draws into the off-screen buffer.
  void render(mjvScene& scene);
  void read(Frame& frame);
  /// Rows from the top; as OpenGL has it, 0 at the near plane and 1 at the far plane.
  void read_depth(std::vector<float>& depth);

 private:
  std::unique_ptr<GlContext> gl_;
  mjrContext context_;
  mjrRect viewport_;
};

}  // namespace patrol::render
