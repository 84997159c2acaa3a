#include "slam/calibration/calibration.h"

namespace patrol::slam {

Pose2 corrected_step(const Pose2& T_before_now, const Calibration& calibration) {
  const Eigen::Vector2d m = Eigen::Rotation2Dd(-0.5 * T_before_now.yaw) * T_before_now.position();
  const double turn_rad = calibration.rotation_scale * T_before_now.yaw + calibration.steering_bias_rad_per_m * m.x();
  const Eigen::Vector2d move = Eigen::Rotation2Dd(0.5 * turn_rad) * (calibration.distance_scale * m);
  return {move.x(), move.y(), wrap_angle(turn_rad)};
}

void CalibratedScans::correct(RecordedScan& recorded) {
  if (calibration_.override_lidar_pose) recorded.T_body_lidar = calibration_.T_body_lidar();
  if (!calibration_.changes_odometry()) return;  // keep the log bit-identical
  const Pose2 T_odom_now = recorded.T_odom_body;
  T_corrected_last_ = T_odom_last_
                          ? T_corrected_last_ * corrected_step(T_odom_last_->inverse() * T_odom_now, calibration_)
                          : T_odom_now;
  T_odom_last_ = T_odom_now;
  recorded.T_odom_body = T_corrected_last_;
  recorded.T_begin_end = corrected_step(recorded.T_begin_end, calibration_);
}

}  // namespace patrol::slam
