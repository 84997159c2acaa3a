#pragma once

#include <memory>
#include <string>

namespace patrol::render {

/// OpenGL implementation for rendering without a display.
enum class Renderer {
  kAuto,    ///< EGL if a graphics card is found, else software
  kOsmesa,  ///< Mesa's software renderer, directly into memory; removed in Mesa 25.1
  kEgl,     ///< a graphics card, or without one Mesa's software renderer
};

/// Parses "auto", "egl" or "osmesa". Throws InputError for any other text.
Renderer parse_renderer(const std::string& name);

/// Software renderer: OSMesa if the program was built with it, else EGL.
Renderer software_renderer();

/// OpenGL context without a window. MuJoCo keeps the function pointers of the first context in a process, so OSMesa and
/// EGL cannot be mixed in one process.
class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes the context current in the calling thread. Throws std::runtime_error on failure.
  virtual void make_current() = 0;
};

/// Throws InputError when the requested renderer is not available, std::runtime_error when it creates no context.
std::unique_ptr<GlContext> make_gl_context(Renderer renderer);

// Implementations, each in its own file.
std::unique_ptr<GlContext> make_osmesa_context();
std::unique_ptr<GlContext> make_egl_context();
/// True when EGL opens a display on a graphics card.
bool has_graphics_card();

}  // namespace patrol::render
