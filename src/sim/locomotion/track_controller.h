#pragma once

#include <array>

#include <Eigen/Geometry>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/drive_speed_controller.h"
#include "sim/locomotion/fall_detector.h"
#include "sim/locomotion/track_drive_settings.h"
#include "sim/locomotion/velocity_ramp.h"

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

  /// Returns true once the robot has fallen over.
  bool has_fallen() const { return fall_detector_.has_fallen(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(speed_controllers_, ramp_, yaw_lag_rad_, gyro_bias_radps_, bias_averaging_s_, idle_s_, is_brake_closed_,
            fall_detector_);
  }

 private:
  double corrected_yaw_rate(const Imu& imu);
  void update_gyro_bias(const Imu& imu);
  double measured_yaw_rate(const Imu& imu) const;
  std::array<double, 2> sprocket_speeds(double speed_mps, double yaw_rate_radps) const;
  void update_brake();

  TrackDriveSettings settings_;
  TrackGeometry tracks_;
  double tick_s_;
  Eigen::Matrix3d R_body_imu_;
  std::array<DriveSpeedController, 2> speed_controllers_;  ///< left, right
  VelocityRamp ramp_;
  double yaw_lag_rad_ = 0.0;
  double gyro_bias_radps_ = 0.0, bias_averaging_s_ = 0.0;  ///< estimated at rest
  double idle_s_ = 0.0;
  bool is_brake_closed_ = false;
  FallDetector fall_detector_;
};

}  // namespace patrol::sim
