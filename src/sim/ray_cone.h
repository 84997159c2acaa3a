#pragma once

#include <cmath>

#include <Eigen/Core>

namespace patrol::sim {

/// Bounds of a bundle of rays: their origins are in a ball, their directions in a circular cone.
struct RayCone {
  Eigen::Vector3d center;       ///< center of the ball
  double radius_m;              ///< radius of the ball
  Eigen::Vector3d axis;         ///< unit vector
  double cosine = 1, sine = 0;  ///< cosine and sine of the half angle, which is at most 90 degrees

  /// Returns whether the ray is one of the bundle.
  bool contains(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    return axis.dot(direction) >= cosine && (origin - center).squaredNorm() <= radius_m * radius_m;
  }

  /// Returns whether a ray of the bundle may hit the ball before `max_range_m`.
  bool may_hit(const Eigen::Vector3d& ball_center, double ball_radius_m, double max_range_m) const {
    const Eigen::Vector3d offset = ball_center - center;
    const double distance_sq = offset.squaredNorm(), reach_m = ball_radius_m + radius_m;
    if (distance_sq <= reach_m * reach_m) return true;
    if (distance_sq > (max_range_m + reach_m) * (max_range_m + reach_m)) return false;
    // The angle between axis and offset is at most half angle + asin(reach / distance).
    return axis.dot(offset) >= cosine * std::sqrt(distance_sq - reach_m * reach_m) - sine * reach_m;
  }
};

}  // namespace patrol::sim
