#pragma once

#include <vector>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/drive_speed_controller.h"
#include "sim/locomotion/fall_detector.h"
#include "sim/locomotion/velocity_ramp.h"
#include "sim/locomotion/wheel_drive_settings.h"

namespace patrol::sim {

/// Command of the firmware to the motors for one tick.
struct WheelDriveCommand {
  std::vector<double> torque_nm;  ///< [joint] as in RobotDescription::joint_names
  bool is_brake_closed = false;   ///< brakes of the driven wheels
};

/// Firmware of a wheeled robot: converts a velocity command to torques of wheels and steering from the joint encoders
/// (core/wheel_kinematics.h). The yaw rate is open loop: it comes from the kinematics alone.
class WheelController {
 public:
  /// `ticks_per_rad`: counts of the encoders per radian of a joint.
  WheelController(const RobotDescription& robot, const WheelDriveSettings& settings, double ticks_per_rad,
                  double tick_s = 0.002);

  WheelDriveCommand step(const Imu& imu, const JointState& joints, const VelocityCommand& command);

  /// Returns true once the robot has fallen over.
  bool has_fallen() const { return fall_detector_.has_fallen(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive.in_place(speed_controllers_);
    archive(ramp_, fall_detector_, target_angle_rad_, slewed_angle_rad_, idle_s_, is_brake_closed_);
  }

 private:
  std::vector<double> wheel_speeds_radps();
  double steering_torque_nm(std::size_t joint, const JointState& joints);
  void update_brake();

  RobotDescription robot_;
  WheelDriveSettings settings_;
  double effective_gauge_ratio_;
  double ticks_per_rad_, tick_s_;
  std::vector<DriveSpeedController> speed_controllers_;  ///< [wheel]; unused for wheels without a motor
  VelocityRamp ramp_;
  FallDetector fall_detector_;
  std::vector<double> target_angle_rad_;  ///< [joint]: steering angle of the kinematics
  std::vector<double> slewed_angle_rad_;  ///< [joint]: approaches the target at the speed of the joint
  double idle_s_ = 0.0;
  bool is_brake_closed_ = false;
};

/// Returns the inertia of a motor behind its gear, kg m2: of a wheel by the settings, of a steering joint so that the
/// maximum torque accelerates it by 100 rad/s2.
double rotor_inertia_kgm2(const RobotDescription& robot, const WheelDriveSettings& settings, std::size_t joint);

}  // namespace patrol::sim
