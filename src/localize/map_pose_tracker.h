#pragma once

#include "core/messages.h"

namespace patrol::localize {

/// How much odometry adds to the uncertainty of a pose, per way and turn since the last correction.
struct OdometryDrift {
  double way_std_m_per_m = 0.02;
  double turn_std_rad_per_m = 0.005;
  double turn_std_rad_per_rad = 0.01;
};

/// The level body in `map` at any time: SLAM's last correction carried on by the smooth odometry,
/// T_map_body = T_map_odom * T_odom_body. Before any correction map and odom are one.
class MapPoseTracker {
 public:
  explicit MapPoseTracker(const OdometryDrift& drift = {}) : drift_(drift) {}

  /// SLAM has placed the body at `stamp`, when odometry had it at `T_odom_body`. Corrections older than the
  /// last are ignored.
  void correct(Time stamp, const Pose2& T_odom_body, const Pose2& T_map_body,
               const Eigen::Matrix3d& covariance);

  PoseEstimate at(Time stamp, const Pose2& T_odom_body) const;
  const Pose2& T_map_odom() const { return T_map_odom_; }

 private:
  OdometryDrift drift_;
  Time corrected_{};
  Pose2 T_map_odom_;
  Pose2 T_odom_corrected_;  ///< where the body was at the last correction
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace patrol::localize
