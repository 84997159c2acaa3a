#include "sim/sensors/surface_optics.h"

#include <algorithm>
#include <string_view>

#include "sim/mujoco.h"

namespace patrol::sim {
namespace {

float reflectivity_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float* rgba = material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
  return 0.2126f * rgba[0] + 0.7152f * rgba[1] + 0.0722f * rgba[2];
}

bool is_glass(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  return material >= 0 && name_of(model, mjOBJ_MATERIAL, material).find("glass") != std::string_view::npos;
}

}  // namespace

bool is_named_after(const mjModel& view, int geom, const std::vector<std::string>& words) {
  const int material = view.geom_matid[geom];
  const std::string_view name = name_of(view, mjOBJ_GEOM, geom),
                         material_name = material < 0 ? "" : name_of(view, mjOBJ_MATERIAL, material);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return !word.empty() &&
           (name.find(word) != std::string_view::npos || material_name.find(word) != std::string_view::npos);
  });
}

std::vector<SurfaceOptics> surface_optics(const mjModel& view) {
  std::vector<SurfaceOptics> surfaces;
  for (int geom = 0; geom < view.ngeom; ++geom) {
    surfaces.push_back({.reflectivity = reflectivity_of(view, geom), .is_glass = is_glass(view, geom)});
  }
  return surfaces;
}

}  // namespace patrol::sim
