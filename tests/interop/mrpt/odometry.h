#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "core/frames.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"

namespace mrpt_stack {

using patrol::Pose2;
using patrol::Time;

/// Odometry of tracks or of wheels that are not steered: distance by the encoders, yaw by the gyro. The tracks or
/// wheels do not measure the yaw, so that their skid does not count.
class Odometry {
 public:
  /// `ticks_per_turn`: counts of the tracks per turn of the sprocket; wheels have their angles.
  Odometry(const patrol::RobotDescription& robot, double ticks_per_turn);

  void add(const patrol::Imu& imu);
  void add(const patrol::TrackTicks& ticks);
  void add(const patrol::JointState& joints);

  const Pose2& pose() const { return T_odom_body_; }
  /// Returns the pose at a stamp of the last half second, between the two readings of the IMU around it.
  Pose2 pose_at(Time stamp) const;
  double distance_m() const { return distance_m_; }
  double speed_mps() const { return speed_mps_; }
  double yaw_rate_radps() const { return yaw_rate_radps_; }

 private:
  void advance(double distance_m, double dt_s);

  patrol::RobotDescription robot_;
  double meters_per_tick_ = 0.0;
  std::optional<patrol::TrackTicks> last_ticks_;
  std::optional<patrol::JointState> last_joints_;
  std::optional<patrol::JointState> rest_joints_;  ///< angles since which the wheels are at rest
  std::optional<Time> last_imu_;
  Pose2 T_odom_body_;
  std::deque<std::pair<Time, Pose2>> history_;
  double distance_m_ = 0.0;
  double speed_mps_ = 0.0;
  double yaw_rate_radps_ = 0.0;
  double gyro_bias_radps_ = 0.0;
  bool is_at_rest_ = true;
  int num_at_rest_ = 0;  ///< number of gyro readings since the robot stands
  int num_in_mean_ = 0;  ///< number of gyro readings in the bias
};

}  // namespace mrpt_stack
