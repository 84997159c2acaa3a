#include "app/check/site_surfaces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/geom_box.h"
#include "sim/ground.h"
#include "sim/robot_model.h"

namespace patrol::app {
namespace {

bool is_endless(const mjModel& model, int geom) { return model.geom_type[geom] == mjGEOM_PLANE; }

bool is_upright(const Eigen::Vector3d& half_m) { return half_m.z() > std::min(half_m.x(), half_m.y()); }

SurfaceKind kind_of(const mjModel& model, const mjData& data, const sim::Ground& ground, double max_step_m, int geom) {
  if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) return SurfaceKind::kUntouchable;
  switch (ground.class_of(geom)) {
    case sim::SurfaceClass::kGround:
      return SurfaceKind::kGround;
    case sim::SurfaceClass::kCurb:
      return SurfaceKind::kCurb;
    case sim::SurfaceClass::kObstacle:
      if (model.body_weldid[model.geom_bodyid[geom]] != 0) return SurfaceKind::kMoving;
      return is_upright(0.5 * sim::geom_box(model, data, geom).sizes()) ? SurfaceKind::kWall : SurfaceKind::kObstacle;
    case sim::SurfaceClass::kByContact:
      break;
  }
  if (is_endless(model, geom) || model.geom_type[geom] == mjGEOM_HFIELD) return SurfaceKind::kGround;
  const Eigen::Vector3d half = 0.5 * sim::geom_box(model, data, geom).sizes();
  if (2.0 * half.z() <= max_step_m) return SurfaceKind::kStep;
  return is_upright(half) ? SurfaceKind::kWall : SurfaceKind::kObstacle;
}

bool is_seen_by_lidars(const mjModel& model, int geom) {
  return model.geom_group[geom] == sim::kGroupSolid || model.geom_group[geom] == sim::kGroupLidarOnly;
}

}  // namespace

SiteSurfaces site_surfaces(const mjModel& site, const sim::GroundSettings& settings) {
  constexpr std::size_t kExamples = 3;
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  const sim::Ground ground(settings, site);
  SiteSurfaces surfaces;
  Eigen::AlignedBox3d box;
  for (int geom = 0; geom < site.ngeom; ++geom) {
    const SurfaceKind kind = kind_of(site, *data, ground, settings.max_step_m, geom);
    SurfaceGroup& group = surfaces.groups[static_cast<std::size_t>(kind)];
    ++group.num_geoms;
    if (is_seen_by_lidars(site, geom)) ++group.num_lidar;
    const std::string_view name = sim::name_of(site, mjOBJ_GEOM, geom);
    if (group.examples.size() < kExamples)
      group.examples.push_back(name.empty() ? fmt::format("geom {}", geom) : std::string(name));
    if (kind == SurfaceKind::kUntouchable || is_endless(site, geom)) continue;
    box.extend(sim::geom_box(site, *data, geom));
  }
  if (!box.isEmpty()) surfaces.lower_m = box.min(), surfaces.upper_m = box.max();
  return surfaces;
}

}  // namespace patrol::app
