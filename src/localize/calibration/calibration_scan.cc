#include "localize/calibration/calibration_scan.h"

#include <Eigen/Geometry>

namespace patrol::localize {
namespace {

/// Returns the covariance of b in the frame of a, for independent errors of the poses in local.
Eigen::Matrix3d relative_covariance(const MatchedScan& a, const MatchedScan& b) {
  const Pose2 T_a_b = a.T_local_level.inverse() * b.T_local_level;
  Eigen::Matrix3d by_b = Eigen::Matrix3d::Identity();
  by_b.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-a.T_local_level.yaw).toRotationMatrix();
  Eigen::Matrix3d by_a = -by_b;
  by_a(0, 2) = T_a_b.y;
  by_a(1, 2) = -T_a_b.x;
  return by_a * a.covariance * by_a.transpose() + by_b * b.covariance * by_b.transpose();
}

}  // namespace

CalibrationStep compare(const CalibrationScan& before, const CalibrationScan& now) {
  CalibrationStep step{.T_before_now_match = before.match.T_local_level.inverse() * now.match.T_local_level,
                       .T_before_now_odom = before.sweep.T_odom_end.inverse() * now.sweep.T_odom_end};
  step.residual = step.T_before_now_match.vector() - step.T_before_now_odom.vector();
  step.residual.z() =
      wrap_angle(step.residual.z() + now.sweep.applied_lidar_yaw_rad - before.sweep.applied_lidar_yaw_rad);
  step.match_covariance = relative_covariance(before.match, now.match);
  const Eigen::Rotation2Dd R_before_odom(-before.sweep.T_odom_end.yaw);
  const Eigen::Vector3d velocity_before = before.sweep.velocity(), velocity_now = now.sweep.velocity();
  step.by_offset_now << -(R_before_odom * velocity_now.head<2>()), -velocity_now.z();
  const Eigen::Vector2d lever(-step.T_before_now_odom.y, step.T_before_now_odom.x);
  step.by_offset_before << -(R_before_odom * velocity_before.head<2>()) - velocity_before.z() * lever,
      -velocity_before.z();
  return step;
}

}  // namespace patrol::localize
