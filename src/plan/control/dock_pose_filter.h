#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/dock_detection.h"
#include "core/settings.h"
#include "plan/control/dock_pose_filter_settings.h"

namespace patrol::plan {

/// Kalman filter of the docked pose T_odom_docked from all detections of the dock. A single detection is accurate to 1
/// cm and 1 degree; about 50 detections are fused during an approach. The process noise is the drift of the odometry
/// since the last detection, by distance, rotation and time: it moves the dock about the robot.
class DockPoseFilter {
 public:
  explicit DockPoseFilter(const DockPoseFilterSettings& settings) : settings_(settings) {}

  void reset();
  /// Fuses a detection. `T_odom_body` is the pose at its stamp. A detection older than the last one is ignored.
  void add(const DockDetection& detection, const Pose2& T_odom_body);

  std::optional<Pose2> T_odom_docked() const { return T_odom_docked_; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }  ///< covariance of x, y, yaw in odom
  int num_detections() const { return num_detections_; }
  Time last_stamp() const { return last_stamp_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(T_odom_docked_, covariance_, T_odom_before_, last_stamp_, num_detections_, num_outliers_);
  }

 private:
  void drift(const Pose2& T_odom_body, double time_s);

  DockPoseFilterSettings settings_;
  std::optional<Pose2> T_odom_docked_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  Pose2 T_odom_before_;  ///< body pose at the last detection
  Time last_stamp_ = Time::min();
  int num_detections_ = 0;
  int num_outliers_ = 0;  ///< number of consecutive outliers
};

}  // namespace patrol::plan
