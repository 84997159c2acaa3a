#include "localize/map_pose_tracker.h"

#include <cmath>

namespace patrol::localize {

void MapPoseTracker::correct(Time stamp, const Pose2& T_odom_body, const Pose2& T_map_body,
                             const Eigen::Matrix3d& covariance) {
  if (stamp < corrected_) return;
  corrected_ = stamp;
  T_map_odom_ = T_map_body * T_odom_body.inverse();
  T_odom_corrected_ = T_odom_body;
  covariance_ = covariance;
}

PoseEstimate MapPoseTracker::at(Time stamp, const Pose2& T_odom_body) const {
  const Pose2 T_map_body = T_map_odom_ * T_odom_body;
  const Eigen::Vector2d displacement = T_map_body.position() - (T_map_odom_ * T_odom_corrected_).position();
  const double rotation = std::abs(wrap_angle(T_odom_body.yaw - T_odom_corrected_.yaw));

  // A heading error at the correction rotates the distance traveled since then.
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -displacement.y();
  F(1, 2) = displacement.x();
  Eigen::Matrix3d covariance = F * covariance_ * F.transpose();
  covariance.diagonal().head<2>().array() += std::pow(drift_.position_std_m_per_m * displacement.norm(), 2);
  covariance(2, 2) +=
      std::pow(drift_.yaw_std_rad_per_m * displacement.norm() + drift_.yaw_std_rad_per_rad * rotation, 2);
  return {.stamp = stamp, .T_map_body = T_map_body, .covariance = covariance};
}

}  // namespace patrol::localize
