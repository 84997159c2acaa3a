#pragma once

#include "core/messages.h"

namespace patrol::localize {

/// Growth of the pose uncertainty by odometry, per distance and rotation since the last correction.
struct OdometryDrift {
  double position_std_m_per_m = 0.02;
  double yaw_std_rad_per_m = 0.005;
  double yaw_std_rad_per_rad = 0.01;
};

/// Pose of the level body in `map` at any time: the last correction of SLAM composed with the continuous odometry,
/// T_map_body = T_map_odom * T_odom_body. Before the first correction map and odom are identical.
class MapPoseTracker {
 public:
  explicit MapPoseTracker(const OdometryDrift& drift = {}) : drift_(drift) {}

  /// Sets the SLAM pose at `stamp`, at which the odometry pose was `T_odom_body`. Corrections older than the last one
  /// are ignored.
  void correct(Time stamp, const Pose2& T_odom_body, const Pose2& T_map_body, const Eigen::Matrix3d& covariance);

  /// Moves map: p_map = T_map_old * p_old.
  void move_map(const Pose2& T_map_old) { T_map_odom_ = T_map_old * T_map_odom_; }

  /// Returns the pose and its covariance at `stamp`, at which the odometry pose is `T_odom_body`.
  PoseEstimate at(Time stamp, const Pose2& T_odom_body) const;
  const Pose2& T_map_odom() const { return T_map_odom_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(corrected_, T_map_odom_, T_odom_corrected_, covariance_);
  }

 private:
  OdometryDrift drift_;
  Time corrected_{};
  Pose2 T_map_odom_;
  Pose2 T_odom_corrected_;  ///< odometry pose at the last correction
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace patrol::localize
