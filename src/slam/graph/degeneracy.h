#pragma once

#include <Eigen/Core>

#include <optional>

namespace patrol::slam {

/// The direction in which a match says next to nothing of the position, as along a smooth wall: in which it says less than `open_share` of what it says in
/// the best one, whatever the heading (Zhang, Kaess, Singh, "On degeneracy of optimization-based state estimation problems", ICRA 2016, with a ratio in place
/// of their threshold). A unit vector in the frame of `information`, which is of x, y, yaw; none if there is none.
std::optional<Eigen::Vector2d> open_direction(const Eigen::Matrix3d& information, double open_share);

/// The information with all taken out that concerns the position along `direction`.
Eigen::Matrix3d without_direction(const Eigen::Matrix3d& information, const Eigen::Vector2d& direction);

}  // namespace patrol::slam
