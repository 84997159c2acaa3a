#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace patrol {

/// Returns the distance from point p to the segment from a to b. The segment may be a single point.
inline double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double along = length2 > 0.0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - along * ab).norm();
}

}  // namespace patrol
