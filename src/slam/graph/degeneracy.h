#pragma once

#include <optional>

#include <Eigen/Core>

namespace patrol::slam {

/// Returns the degenerate direction of a match, for example along a smooth wall [Zhang16]. A direction is degenerate if
/// its information, with free heading, is below `min_eigenvalue_ratio` of that in the best direction. Result: unit
/// vector in the frame of `information`, which is for x, y, yaw; none if both directions are constrained.
///
/// Deviation from [Zhang16]: a ratio of eigenvalues instead of an absolute threshold.
std::optional<Eigen::Vector2d> degenerate_direction(const Eigen::Matrix3d& information, double min_eigenvalue_ratio);

/// Returns the offset (x, y, yaw) between two poses without its part along the degenerate direction of a match, which
/// the match does not determine.
Eigen::Vector3d determined_offset(const Eigen::Vector3d& offset, const Eigen::Matrix3d& information,
                                  double min_eigenvalue_ratio);

/// Removes all information about the position along `direction`.
Eigen::Matrix3d project_out(const Eigen::Matrix3d& information, const Eigen::Vector2d& direction);

}  // namespace patrol::slam
