#include "sim/ground.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/mujoco.h"
#include "sim/static_obstacles.h"

namespace patrol::sim {
namespace {

/// Returns the height of the highest point of a geom's bounding box in world, m.
double top_m(const mjModel& model, const mjData& data, int geom) {
  const mjtNum* box = model.geom_aabb + 6 * geom;  // center and half sizes, in the geom's frame
  const mjtNum* up = data.geom_xmat + 9 * geom + 6;
  double top = data.geom_xpos[3 * geom + 2];
  for (int axis = 0; axis < 3; ++axis) top += up[axis] * box[axis] + std::abs(up[axis]) * box[3 + axis];
  return top;
}

bool matches_any(const std::vector<std::string>& patterns, std::string_view text) {
  return !text.empty() &&
         std::any_of(patterns.begin(), patterns.end(), [&](const std::string& p) { return matches(p, text); });
}

bool selects(const GeomPatterns& patterns, const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const std::string group = std::to_string(model.geom_group[geom]);
  return matches_any(patterns.geoms, name_of(model, mjOBJ_GEOM, geom)) ||
         (material >= 0 && matches_any(patterns.materials, name_of(model, mjOBJ_MATERIAL, material))) ||
         std::find(patterns.groups.begin(), patterns.groups.end(), group) != patterns.groups.end();
}

/// Returns whether the normal from the geom to the robot is within 45 degrees of the vertical.
bool is_from_above(const mjContact& contact, int geom) {
  const mjtNum up = contact.frame[2];  // of the normal, from the first geom to the second
  return (contact.geom[0] == geom ? up : -up) >= std::sqrt(0.5);
}

}  // namespace

bool matches(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  const std::string_view rest = pattern.substr(star + 1);
  for (std::size_t at = star; at <= text.size(); ++at) {
    if (matches(rest, text.substr(at))) return true;
  }
  return false;
}

Ground::Ground(const GroundSettings& settings, const mjModel& model) : settings_(settings) {
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const bool is_scenery = model.body_weldid[model.geom_bodyid[geom]] == 0 &&
                            !name_of(model, mjOBJ_GEOM, geom).starts_with(kStaticObstacle);
    SurfaceClass surface = SurfaceClass::kObstacle;
    if (selects(settings.all, model, geom)) surface = SurfaceClass::kGround;
    else if (selects(settings.curbs, model, geom)) surface = SurfaceClass::kCurb;
    else if (is_scenery && settings.max_step_m > 0.0) surface = SurfaceClass::kByContact;
    classes_.push_back(surface);
  }
}

bool Ground::is_footing(const mjModel& model, const mjData& data, const mjContact& contact, int geom,
                        double lowest_m) const {
  switch (class_of(geom)) {
    case SurfaceClass::kGround:
      return true;
    case SurfaceClass::kCurb:
      return is_from_above(contact, geom) || top_m(model, data, geom) - lowest_m <= settings_.max_curb_m;
    case SurfaceClass::kByContact:
      return (is_from_above(contact, geom) && contact.pos[2] - lowest_m <= settings_.max_step_m) ||
             top_m(model, data, geom) - lowest_m <= settings_.max_curb_m;
    case SurfaceClass::kObstacle:
      break;
  }
  return false;
}

}  // namespace patrol::sim
