#pragma once

#include <Eigen/Core>

#include <optional>

#include "core/dock_detection.h"
#include "core/settings.h"

namespace patrol::plan {

struct DockPoseFilterSettings {
  double position_std_m_per_m = 0.03;      ///< odometry drift between two detections
  double yaw_std_rad_per_rad = 0.05;
  double yaw_std_rad_per_m = 0.01;
  double yaw_random_walk_rad_per_sqrt_s = 0.003;  ///< drift of the gyro bias, also at rest
  double lateral_std_m_per_rad = 0.03;   ///< sideways displacement during a skidding turn
  double min_std_m = 0.002;         ///< minimum std of a detection: errors common to one pose
  double min_std_rad = 0.002;
  double gate = 16.0;                 ///< squared Mahalanobis distance from which a detection is an outlier

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_std_m_per_m", self.position_std_m_per_m, between(0.0, 1.0));
    visit("yaw_std_rad_per_rad", self.yaw_std_rad_per_rad, between(0.0, 1.0));
    visit("yaw_std_rad_per_m", self.yaw_std_rad_per_m, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_s", self.yaw_random_walk_rad_per_sqrt_s, between(0.0, 1.0));
    visit("lateral_std_m_per_rad", self.lateral_std_m_per_rad, between(0.0, 1.0));
    visit("min_std_m", self.min_std_m, between(1e-4, 0.1));
    visit("min_std_rad", self.min_std_rad, between(1e-4, 0.1));
    visit("gate", self.gate, between(1.0, 1000.0));
  }
};

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
