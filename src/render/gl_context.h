#pragma once

#include <memory>
#include <string>

namespace patrol::render {

/// Whose OpenGL draws, without a display.
enum class Renderer {
  kAuto,    ///< EGL where a graphics card answers, else software
  kOsmesa,  ///< Mesa's software renderer, straight into memory; gone from Mesa 25.1 on
  kEgl,     ///< a graphics card, or where there is none the same software renderer
};

/// "auto", "egl" or "osmesa"; throws InputError for anything else.
Renderer renderer_named(const std::string& name);

/// Software: OSMesa where the program was built with it, else EGL.
Renderer software_renderer();

/// An OpenGL context that has no window. MuJoCo takes the functions of the first context that it meets in a process, and keeps
/// them: two kinds do not go together in one process.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// In this thread. Throws std::runtime_error when it cannot be.
  virtual void make_current() = 0;
};

/// Throws InputError when the renderer asked for is not there, std::runtime_error when it gives no context.
std::unique_ptr<GlContext> make_gl_context(Renderer renderer);

// The kinds, each in a file of its own.
std::unique_ptr<GlContext> make_osmesa_context();
std::unique_ptr<GlContext> make_egl_context();
/// Whether EGL finds a graphics card that answers.
bool has_graphics_card();

}  // namespace patrol::render
