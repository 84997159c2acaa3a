#pragma once

#include <Eigen/Geometry>

#include <array>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/sprocket_regulator.h"
#include "sim/locomotion/track_drive_settings.h"

namespace patrol::sim {

/// What the firmware asks of the drives for a tick.
struct TrackOrders {
  std::array<double, 2> torque_nm{};  ///< left, right; at the sprocket
  bool is_brake_closed = false;
};

/// The firmware of a tracked robot: turns a velocity command into sprocket torques, from Hall ticks and IMU alone.
///
/// Kinematics: a track that runs at u_left, u_right moves the robot at v = (u_right + u_left) / 2 and turns it at
/// w = (u_right - u_left) / B. Since tracks scrub as they turn, B is wider than their gauge: the centres of rotation of the two
/// tracks lie that far apart (Martinez et al., "Approximating Kinematics for Tracked Mobile Robots", IJRR 2005).
class TrackController {
 public:
  TrackController(const RobotDescription& robot, const TrackDriveSettings& settings, double ticks_per_rad,
                  double tick_s = 0.002);

  TrackOrders step(const Imu& imu, const TrackTicks& ticks, const VelocityCommand& command);

  /// True once the robot has been tilted beyond 60 degrees for 0.3 s.
  bool has_fallen() const { return fallen_s_ > 0.3; }

 private:
  void watch_for_fall(const Imu& imu);
  void follow_command(const VelocityCommand& command);
  double corrected_yaw_rate(const Imu& imu);
  void learn_bias(const Imu& imu);
  double measured_yaw_rate(const Imu& imu) const;
  std::array<double, 2> sprocket_speeds(double speed_mps, double yaw_rate_radps) const;
  void update_brake();
  bool is_asked_to_rest() const;

  TrackDriveSettings settings_;
  TrackGeometry tracks_;
  double tick_s_;
  Eigen::Matrix3d R_body_imu_;
  std::array<SprocketRegulator, 2> regulators_;  ///< left, right
  double speed_mps_ = 0.0, yaw_rate_radps_ = 0.0;  ///< asked, within the limits of acceleration
  double yaw_behind_rad_ = 0.0;
  double gyro_bias_radps_ = 0.0, learning_s_ = 0.0;  ///< learnt at rest
  double idle_s_ = 0.0;
  bool is_brake_closed_ = false;
  Eigen::Vector3d up_in_body_ = Eigen::Vector3d::UnitZ();
  double age_s_ = 0.0;  ///< since switch-on
  double fallen_s_ = 0.0;
};

}  // namespace patrol::sim
