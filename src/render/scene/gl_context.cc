#include "render/scene/gl_context.h"

#include "core/error.h"

namespace patrol::render {
namespace {

#ifdef PATROL_HAS_OSMESA
constexpr bool kHasOsmesa = true;
#else
constexpr bool kHasOsmesa = false;
#endif

}  // namespace

#ifndef PATROL_HAS_OSMESA
std::unique_ptr<GlContext> make_osmesa_context() {
  throw InputError("renderer = osmesa: this program was built without OSMesa");
}
#endif

Renderer parse_renderer(const std::string& name) {
  if (name == "auto") return Renderer::kAuto;
  if (name == "egl") return Renderer::kEgl;
  if (name != "osmesa") throw InputError(name + ": must be one of auto, egl, osmesa");
  return Renderer::kOsmesa;
}

Renderer software_renderer() { return kHasOsmesa ? Renderer::kOsmesa : Renderer::kEgl; }

std::unique_ptr<GlContext> make_gl_context(Renderer renderer) {
  if (renderer == Renderer::kAuto) renderer = has_graphics_card() ? Renderer::kEgl : software_renderer();
  return renderer == Renderer::kEgl ? make_egl_context() : make_osmesa_context();
}

}  // namespace patrol::render
