#include "plan/control/dock_pose_filter.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace patrol::plan {
namespace {

constexpr int kMaxOutliers = 5;  // consecutive outliers after which the estimate is reset

/// Jacobian of an observed pose in odom by a small displacement (x, y, yaw) of the body in its own frame.
Eigen::Matrix3d body_motion_jacobian(const Pose2& T_odom_body, const Pose2& T_odom_observed) {
  const double c = std::cos(T_odom_body.yaw), s = std::sin(T_odom_body.yaw);
  const Eigen::Vector2d arm = T_odom_observed.position() - T_odom_body.position();
  Eigen::Matrix3d J;
  J << c, -s, -arm.y(), s, c, arm.x(), 0.0, 0.0, 1.0;
  return J;
}

}  // namespace

void DockPoseFilter::reset() { *this = DockPoseFilter(settings_); }

void DockPoseFilter::drift(const Pose2& T_odom_body, double time_s) {
  const Pose2 motion = T_odom_before_.inverse() * T_odom_body;
  const double distance_m = motion.position().norm(), turn_rad = std::abs(motion.yaw);
  const double position_std = settings_.position_std_m_per_m * distance_m;
  const double lateral_std = std::hypot(position_std, settings_.lateral_std_m_per_rad * turn_rad);
  const double yaw_std = std::hypot(settings_.yaw_std_rad_per_rad * turn_rad + settings_.yaw_std_rad_per_m * distance_m,
                                    settings_.yaw_random_walk_rad_per_sqrt_s * std::sqrt(time_s));
  const Eigen::Vector3d body_std(position_std, lateral_std, yaw_std);
  const Eigen::Matrix3d J = body_motion_jacobian(T_odom_body, *T_odom_docked_);
  covariance_ += J * body_std.cwiseAbs2().asDiagonal() * J.transpose();
}

void DockPoseFilter::add(const DockDetection& detection, const Pose2& T_odom_body) {
  if (detection.stamp <= last_stamp_) return;
  const Pose2 seen = T_odom_body * detection.T_level_docked;
  const double c = std::cos(T_odom_body.yaw), s = std::sin(T_odom_body.yaw);
  Eigen::Matrix3d R;  // level to odom
  R << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  Eigen::Matrix3d observed_covariance = R * detection.covariance * R.transpose();
  const Eigen::Vector3d min_std(settings_.min_std_m, settings_.min_std_m, settings_.min_std_rad);
  observed_covariance += min_std.cwiseAbs2().asDiagonal();

  if (T_odom_docked_) drift(T_odom_body, to_seconds(detection.stamp - last_stamp_));
  T_odom_before_ = T_odom_body;
  last_stamp_ = detection.stamp;
  if (!T_odom_docked_ || num_outliers_ >= kMaxOutliers) {
    T_odom_docked_ = seen;
    covariance_ = observed_covariance;
    num_outliers_ = 0;
    num_detections_ = 1;
    return;
  }
  const Eigen::Vector3d innovation(seen.x - T_odom_docked_->x, seen.y - T_odom_docked_->y,
                                   wrap_angle(seen.yaw - T_odom_docked_->yaw));
  const Eigen::Matrix3d inverse = (covariance_ + observed_covariance).inverse();
  if (innovation.dot(inverse * innovation) > settings_.gate) {
    ++num_outliers_;
    return;
  }
  const Eigen::Matrix3d gain = covariance_ * inverse;
  const Eigen::Vector3d step = gain * innovation;
  T_odom_docked_ =
      Pose2{T_odom_docked_->x + step.x(), T_odom_docked_->y + step.y(), wrap_angle(T_odom_docked_->yaw + step.z())};
  covariance_ = (Eigen::Matrix3d::Identity() - gain) * covariance_;
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
  num_outliers_ = 0;
  ++num_detections_;
}

}  // namespace patrol::plan
