#include "sim/locomotion/wheel_controller.h"

#include <algorithm>
#include <cmath>

#include "core/wheel_kinematics.h"

namespace patrol::sim {
namespace {

constexpr double kRestWheel_mps = 0.02;  // slower wheels are at rest

// Steering servo: full torque at an error of 0.1 rad, critically damped on its own rotor.
constexpr double kSteeringRotor_radps2 = 100.0, kSteeringFullTorque_rad = 0.1;

/// Returns the mass on one driven wheel times its squared radius, kg m2.
double carried_inertia_kgm2(const RobotDescription& robot, const WheelGeometry& wheel) {
  const auto num_driven = std::count_if(robot.wheels.begin(), robot.wheels.end(),
                                        [](const WheelGeometry& each) { return each.drive_joint.has_value(); });
  return robot.mass_kg / static_cast<double>(num_driven) * wheel.radius_m * wheel.radius_m;
}

/// Critically damped PI control of the wheel with the mass that it carries.
DriveSpeedGains gains_of(const RobotDescription& robot, const WheelDriveSettings& settings,
                         const WheelGeometry& wheel) {
  const double inertia_kgm2 = (1.0 + settings.rotor_inertia_ratio) * carried_inertia_kgm2(robot, wheel);
  const double bandwidth = settings.speed_bandwidth_radps;
  return {.kp_nms = bandwidth * inertia_kgm2,
          .ki_nm = 0.25 * bandwidth * bandwidth * inertia_kgm2,
          .kd_nms2 = 0.0,
          .observer_bandwidth_radps = settings.observer_bandwidth_radps};
}

VelocityRamp::Limits limits_of(const RobotDescription& robot, const WheelDriveSettings& settings) {
  return {.speed_mps = settings.max_speed_mps,
          .yaw_rate_radps = settings.max_yaw_rate_radps,
          .acceleration_mps2 = settings.max_acceleration_mps2,
          .yaw_acceleration_radps2 = settings.max_yaw_acceleration_radps2,
          .lateral_mps = has_rollers(robot) ? settings.max_lateral_speed_mps : 0.0};
}

DriveMotor wheel_motor(const JointLimit& limit, const WheelDriveSettings& settings) {
  return {.max_torque_nm = limit.effort_nm,
          .stall_torque_nm = settings.stall_torque_ratio * limit.effort_nm,
          .no_load_radps = limit.velocity_radps};
}

}  // namespace

double rotor_inertia_kgm2(const RobotDescription& robot, const WheelDriveSettings& settings, std::size_t joint) {
  for (const WheelGeometry& wheel : robot.wheels) {
    if (wheel.drive_joint == joint) return settings.rotor_inertia_ratio * carried_inertia_kgm2(robot, wheel);
  }
  return robot.joint_limits.at(joint).effort_nm / kSteeringRotor_radps2;
}

WheelController::WheelController(const RobotDescription& robot, const WheelDriveSettings& settings,
                                 double ticks_per_rad, double tick_s)
    : robot_(robot),
      settings_(settings),
      effective_gauge_ratio_(settings.effective_gauge_factor > 0.0 ? settings.effective_gauge_factor
                                                                   : skid_ratio(robot)),
      ticks_per_rad_(ticks_per_rad),
      tick_s_(tick_s),
      ramp_(limits_of(robot, settings), tick_s),
      fall_detector_(robot.T_body("imu").rotation.toRotationMatrix(), tick_s),
      target_angle_rad_(robot.joint_names.size(), 0.0),
      slewed_angle_rad_(robot.joint_names.size(), 0.0) {
  validate(settings, "wheel_drive");
  for (const WheelGeometry& wheel : robot.wheels) {
    const DriveMotor motor =
        wheel.drive_joint ? wheel_motor(robot.joint_limits[*wheel.drive_joint], settings) : DriveMotor{};
    speed_controllers_.emplace_back(gains_of(robot, settings, wheel), motor, ticks_per_rad, tick_s);
  }
}

WheelDriveCommand WheelController::step(const Imu& imu, const JointState& joints, const VelocityCommand& command) {
  fall_detector_.step(imu);
  ramp_.step(command);
  WheelDriveCommand drive_command{.torque_nm = std::vector<double>(robot_.joint_names.size(), 0.0)};
  const std::vector<double> speed_radps = wheel_speeds_radps();
  for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
    const WheelGeometry& wheel = robot_.wheels[i];
    if (wheel.steering_joint)
      drive_command.torque_nm[*wheel.steering_joint] = steering_torque_nm(*wheel.steering_joint, joints);
    if (!wheel.drive_joint) continue;
    const std::int64_t count = std::llround(joints.position_rad[*wheel.drive_joint] * ticks_per_rad_);
    drive_command.torque_nm[*wheel.drive_joint] = speed_controllers_[i].step(speed_radps[*wheel.drive_joint], count);
  }
  update_brake();
  drive_command.is_brake_closed = is_brake_closed_;
  if (!is_brake_closed_) return drive_command;
  for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
    speed_controllers_[i].reset();
    if (robot_.wheels[i].drive_joint) drive_command.torque_nm[*robot_.wheels[i].drive_joint] = 0.0;
  }
  return drive_command;
}

/// Returns the wheel speeds [joint]. If a motor exceeds its no-load speed, all are scaled to keep the curvature.
std::vector<double> WheelController::wheel_speeds_radps() {
  WheelCommand command = wheel_command(robot_, ramp_.speed_mps(), ramp_.yaw_rate_radps(), effective_gauge_ratio_,
                                       target_angle_rad_, ramp_.lateral_mps());
  target_angle_rad_ = std::move(command.angle_rad);
  limit_wheel_speeds(robot_, command.speed_radps);
  return std::move(command.speed_radps);
}

double WheelController::steering_torque_nm(std::size_t joint, const JointState& joints) {
  const JointLimit& limit = robot_.joint_limits[joint];
  slewed_angle_rad_[joint] =
      moved_toward(slewed_angle_rad_[joint], target_angle_rad_[joint], limit.velocity_radps * tick_s_);
  const double stiffness_nm = limit.effort_nm / kSteeringFullTorque_rad;
  const double rotor_kgm2 = limit.effort_nm / kSteeringRotor_radps2;
  const double torque_nm = stiffness_nm * (slewed_angle_rad_[joint] - joints.position_rad[joint]) -
                           2.0 * std::sqrt(stiffness_nm * rotor_kgm2) * joints.velocity_radps[joint];
  return std::clamp(torque_nm, -limit.effort_nm, limit.effort_nm);
}

/// Closes the brakes after all wheels have been at rest without command; opens them on command only.
void WheelController::update_brake() {
  bool is_still = true;
  for (std::size_t i = 0; i < robot_.wheels.size(); ++i) {
    const WheelGeometry& wheel = robot_.wheels[i];
    if (wheel.drive_joint && std::abs(speed_controllers_[i].speed_radps()) * wheel.radius_m > kRestWheel_mps)
      is_still = false;
  }
  idle_s_ = ramp_.is_at_rest() && (is_still || is_brake_closed_) ? idle_s_ + tick_s_ : 0.0;
  is_brake_closed_ = idle_s_ > settings_.brake_delay_s;
}

}  // namespace patrol::sim
