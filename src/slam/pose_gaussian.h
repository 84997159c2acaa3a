#pragma once

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// Normally distributed body pose in map, with the covariance of x, y, yaw in map (m, m, rad).
struct PoseGaussian {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// Difference (dx, dy, dyaw) of a pose from the mean, in map; the angle is wrapped.
  Eigen::Vector3d residual_to_mean(const Pose2& T_map_body) const {
    return {T_map_body.x - mean.x, T_map_body.y - mean.y, wrap_angle(T_map_body.yaw - mean.yaw)};
  }
};

/// Returns the pose perturbed by (dx, dy, dyaw) in map.
inline Pose2 perturbed(const Pose2& T_map_body, const Eigen::Vector3d& offset) {
  return {T_map_body.x + offset.x(), T_map_body.y + offset.y(), wrap_angle(T_map_body.yaw + offset.z())};
}

}  // namespace patrol::slam
