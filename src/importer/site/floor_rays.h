#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "sim/lidar_scene.h"

namespace patrol::importer {

/// Vertical and horizontal rays to the surfaces of a site that its lidars see, at the initial poses of the bodies.
class FloorRays {
 public:
  /// `site` must outlive the rays.
  explicit FloorRays(const mjModel& site);

  /// Returns the box around the geoms that have an end, in world; the origin if there are none.
  const Eigen::AlignedBox3d& box() const { return box_; }

  /// Returns the height of the first surface below a point; none above nothing.
  std::optional<double> surface_below_m(const Eigen::Vector2d& p_m, double from_m) const;

  /// Returns the height of the lowest surface with `free_m` of free height above it; none if there is none.
  std::optional<double> lowest_floor_m(const Eigen::Vector2d& p_m, double free_m) const;

  /// Returns the distance of the first surface along a unit vector; none beyond `max_m`.
  std::optional<double> distance_m(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction,
                                   double max_m) const;

 private:
  sim::LidarScene scene_;
  Eigen::AlignedBox3d box_;
};

}  // namespace patrol::importer
