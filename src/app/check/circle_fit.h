#pragma once

#include <vector>

#include <Eigen/Core>

namespace patrol::app {

struct Circle {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

/// Circle with the least sum of squared algebraic distances (Kasa): |p|^2 = 2 c.p + r^2 - |c|^2 is linear in its
/// unknowns. At least three points that are not on a line.
Circle fit_circle(const std::vector<Eigen::Vector2d>& points_m);

}  // namespace patrol::app
