#include "importer/site/floor_rays.h"

#include <algorithm>
#include <limits>

#include "sim/geom_box.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

constexpr double kAboveSurface_m = 1e-3;  // distance of a ray's origin from the surface below it

/// Box around the geoms that have an end, in world.
Eigen::AlignedBox3d box_around(const mjModel& site) {
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  Eigen::AlignedBox3d box;
  for (int geom = 0; geom < site.ngeom; ++geom) {
    if (site.geom_type[geom] == mjGEOM_PLANE) continue;
    box.extend(sim::geom_box(site, *data, geom));
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return box;
}

}  // namespace

FloorRays::FloorRays(const mjModel& site) : scene_(site), box_(box_around(site)) {}

std::optional<double> FloorRays::surface_below_m(const Eigen::Vector2d& p_m, double from_m) const {
  const double depth_m = from_m - box_.min().z() + 1.0;
  const std::optional<double> below_m =
      distance_m({p_m.x(), p_m.y(), from_m}, {0.0, 0.0, -1.0}, std::max(depth_m, 1.0));
  return below_m ? std::optional(from_m - *below_m) : std::nullopt;
}

std::optional<double> FloorRays::lowest_floor_m(const Eigen::Vector2d& p_m, double free_m) const {
  constexpr int kMaxSurfaces = 100;
  std::optional<double> floor_m;
  double above_m = std::numeric_limits<double>::infinity(), from_m = box_.max().z() + free_m + 1.0;
  for (int i = 0; i < kMaxSurfaces; ++i) {
    const std::optional<double> height_m = surface_below_m(p_m, from_m);
    if (!height_m) break;
    if (above_m - *height_m >= free_m) floor_m = height_m;
    above_m = *height_m;
    from_m = *height_m - kAboveSurface_m;
  }
  return floor_m;
}

std::optional<double> FloorRays::distance_m(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                                            double max_m) const {
  const auto hit = scene_.cast(origin_m, direction, max_m, sim::kRayEverything);
  return hit ? std::optional(hit->distance_m) : std::nullopt;
}

}  // namespace patrol::importer
