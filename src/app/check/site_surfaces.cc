#include "app/check/site_surfaces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sim/ground.h"
#include "sim/robot_model.h"

namespace patrol::app {
namespace {

using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Center of a geom's bounding box in world, m.
Eigen::Vector3d box_center_m(const mjModel& model, const mjData& data, int geom) {
  const Eigen::Map<const RowMatrix> rotation(data.geom_xmat + 9 * geom);
  const Eigen::Map<const Eigen::Vector3d> position(data.geom_xpos + 3 * geom), center(model.geom_aabb + 6 * geom);
  return position + rotation * center;
}

/// Half sizes of a geom's bounding box along the axes of the world, m.
Eigen::Vector3d half_box_m(const mjModel& model, const mjData& data, int geom) {
  const Eigen::Map<const RowMatrix> rotation(data.geom_xmat + 9 * geom);
  return rotation.cwiseAbs() * Eigen::Map<const Eigen::Vector3d>(model.geom_aabb + 6 * geom + 3);
}

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
      return is_upright(half_box_m(model, data, geom)) ? SurfaceKind::kWall : SurfaceKind::kObstacle;
    case sim::SurfaceClass::kByContact:
      break;
  }
  if (is_endless(model, geom) || model.geom_type[geom] == mjGEOM_HFIELD) return SurfaceKind::kGround;
  const Eigen::Vector3d half = half_box_m(model, data, geom);
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
  bool is_first = true;
  for (int geom = 0; geom < site.ngeom; ++geom) {
    const SurfaceKind kind = kind_of(site, *data, ground, settings.max_step_m, geom);
    SurfaceGroup& group = surfaces.groups[static_cast<std::size_t>(kind)];
    ++group.num_geoms;
    if (is_seen_by_lidars(site, geom)) ++group.num_lidar;
    const std::string_view name = sim::name_of(site, mjOBJ_GEOM, geom);
    if (group.examples.size() < kExamples)
      group.examples.push_back(name.empty() ? fmt::format("geom {}", geom) : std::string(name));
    if (kind == SurfaceKind::kUntouchable || is_endless(site, geom)) continue;
    const Eigen::Vector3d center = box_center_m(site, *data, geom), half = half_box_m(site, *data, geom);
    surfaces.lower_m = is_first ? Eigen::Vector3d(center - half) : surfaces.lower_m.cwiseMin(center - half);
    surfaces.upper_m = is_first ? Eigen::Vector3d(center + half) : surfaces.upper_m.cwiseMax(center + half);
    is_first = false;
  }
  return surfaces;
}

}  // namespace patrol::app
