#include "sim/sensors/surface_optics.h"

#include <string_view>

namespace patrol::sim {
namespace {

float reflectivity_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float* rgba = material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
  return 0.2126f * rgba[0] + 0.7152f * rgba[1] + 0.0722f * rgba[2];
}

bool is_glass(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  if (material < 0) return false;
  const char* name = mj_id2name(&model, mjOBJ_MATERIAL, material);
  return name != nullptr && std::string_view(name).find("glass") != std::string_view::npos;
}

}  // namespace

std::vector<SurfaceOptics> surface_optics(const mjModel& view) {
  std::vector<SurfaceOptics> surfaces;
  for (int geom = 0; geom < view.ngeom; ++geom) {
    surfaces.push_back({.reflectivity = reflectivity_of(view, geom), .is_glass = is_glass(view, geom)});
  }
  return surfaces;
}

}  // namespace patrol::sim
