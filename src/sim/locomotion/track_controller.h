#pragma once

#include <array>

#include <Eigen/Geometry>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/sprocket_speed_controller.h"
#include "sim/locomotion/track_drive_settings.h"

namespace patrol::sim {

/// Command of the firmware to the drives for one tick.
struct TrackDriveCommand {
  std::array<double, 2> torque_nm{};  ///< torque at the sprocket: left, right
  bool is_brake_closed = false;
};

/// Firmware of a tracked robot: converts a velocity command to sprocket torques from Hall counts and IMU.
///
/// Kinematics: tracks at speeds u_left, u_right give v = (u_right + u_left) / 2 and w = (u_right - u_left) / B. Since
/// tracks scrub during a turn, B exceeds their gauge: it is the distance between the instantaneous centers of rotation
/// of the two tracks [Martinez05].
class TrackController {
 public:
  TrackController(const RobotDescription& robot, const TrackDriveSettings& settings, double ticks_per_rad,
                  double tick_s = 0.002);

  TrackDriveCommand step(const Imu& imu, const TrackTicks& ticks, const VelocityCommand& command);

  /// Returns true once the robot has been tilted beyond 60 degrees for 0.3 s.
  bool has_fallen() const { return fallen_s_ > 0.3; }

 private:
  void detect_fall(const Imu& imu);
  void follow_command(const VelocityCommand& command);
  double corrected_yaw_rate(const Imu& imu);
  void update_gyro_bias(const Imu& imu);
  double measured_yaw_rate(const Imu& imu) const;
  std::array<double, 2> sprocket_speeds(double speed_mps, double yaw_rate_radps) const;
  void update_brake();
  bool is_commanded_to_rest() const;

  TrackDriveSettings settings_;
  TrackGeometry tracks_;
  double tick_s_;
  Eigen::Matrix3d R_body_imu_;
  std::array<SprocketSpeedController, 2> speed_controllers_;  ///< left, right
  double speed_mps_ = 0.0, yaw_rate_radps_ = 0.0;             ///< rate-limited command
  double yaw_lag_rad_ = 0.0;
  double gyro_bias_radps_ = 0.0, bias_averaging_s_ = 0.0;  ///< estimated at rest
  double idle_s_ = 0.0;
  bool is_brake_closed_ = false;
  Eigen::Vector3d up_in_body_ = Eigen::Vector3d::UnitZ();
  double age_s_ = 0.0;  ///< time since switch-on
  double fallen_s_ = 0.0;
};

}  // namespace patrol::sim
