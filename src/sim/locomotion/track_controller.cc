#include "sim/locomotion/track_controller.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angles.h"

namespace patrol::sim {
namespace {

constexpr double kRestSpeed_mps = 0.005, kRestRate_radps = 0.005;  // smaller commands are treated as zero
constexpr double kRestSprocket_radps = 0.5;                        // a single count back and forth appears as 0.3
constexpr double kBiasTime_s = 5.0;                                // averaging time of the gyroscope bias at rest
constexpr double kLevelingRate_per_s = 0.5;  // rate of the accelerometer correction of the attitude
constexpr double kLevelSettling_s = 0.5;     // time after switch-on with the accelerometer only
const double kFallenCosine = std::cos(to_rad(60.0));

double approach_speed(double value, double target, double max_change) {
  return value + std::clamp(target - value, -max_change, max_change);
}

TrackMotor motor_of(const JointLimit& limit, const TrackDriveSettings& settings) {
  return {.max_torque_nm = limit.effort_nm,
          .stall_torque_nm = settings.stall_torque_nm,
          .no_load_radps = limit.velocity_radps};
}

}  // namespace

TrackController::TrackController(const RobotDescription& robot, const TrackDriveSettings& settings,
                                 double ticks_per_rad, double tick_s)
    : settings_(settings),
      tracks_(robot.tracks.value()),
      tick_s_(tick_s),
      R_body_imu_(robot.T_body("imu").rotation.toRotationMatrix()),
      speed_controllers_{
          SprocketSpeedController(settings, motor_of(robot.joint_limits[0], settings), ticks_per_rad, tick_s),
          SprocketSpeedController(settings, motor_of(robot.joint_limits[1], settings), ticks_per_rad, tick_s)} {
  validate(settings, "track_drive");
}

TrackDriveCommand TrackController::step(const Imu& imu, const TrackTicks& ticks, const VelocityCommand& command) {
  detect_fall(imu);
  follow_command(command);
  const std::array<double, 2> requested_radps = sprocket_speeds(speed_mps_, corrected_yaw_rate(imu));
  TrackDriveCommand drive_command{.torque_nm = {speed_controllers_[0].step(requested_radps[0], ticks.left),
                                                speed_controllers_[1].step(requested_radps[1], ticks.right)}};
  update_brake();
  if (is_brake_closed_) {
    for (SprocketSpeedController& regulator : speed_controllers_) regulator.reset();
    update_gyro_bias(imu);
    drive_command = {.is_brake_closed = true};
  }
  return drive_command;
}

void TrackController::follow_command(const VelocityCommand& command) {
  const double speed = std::clamp(command.vx_mps, -settings_.max_speed_mps, settings_.max_speed_mps);
  const double rate = std::clamp(command.yaw_rate_radps, -settings_.max_yaw_rate_radps, settings_.max_yaw_rate_radps);
  speed_mps_ = approach_speed(speed_mps_, speed, settings_.max_acceleration_mps2 * tick_s_);
  yaw_rate_radps_ = approach_speed(yaw_rate_radps_, rate, settings_.max_yaw_acceleration_radps2 * tick_s_);
}

/// Returns the yaw rate command for the kinematics such that the gyroscope measures the requested yaw rate.
double TrackController::corrected_yaw_rate(const Imu& imu) {
  if (!settings_.use_gyro) return yaw_rate_radps_;
  if (is_commanded_to_rest()) {
    yaw_lag_rad_ = 0.0;
    return yaw_rate_radps_;
  }
  const double yaw_rate_error_radps = yaw_rate_radps_ - (measured_yaw_rate(imu) - gyro_bias_radps_);
  const double limit = settings_.max_gyro_correction_radps;
  const double gain = settings_.gyro_integral_per_s;
  if (gain > 0.0) yaw_lag_rad_ = std::clamp(yaw_lag_rad_ + tick_s_ * yaw_rate_error_radps, -limit / gain, limit / gain);
  return yaw_rate_radps_ + std::clamp(settings_.gyro_gain * yaw_rate_error_radps + gain * yaw_lag_rad_, -limit, limit);
}

/// Updates the gyroscope bias: mean over the first seconds at rest, running mean afterward.
void TrackController::update_gyro_bias(const Imu& imu) {
  bias_averaging_s_ = std::min(bias_averaging_s_ + tick_s_, kBiasTime_s);
  gyro_bias_radps_ += tick_s_ / bias_averaging_s_ * (measured_yaw_rate(imu) - gyro_bias_radps_);
}

double TrackController::measured_yaw_rate(const Imu& imu) const {
  return up_in_body_.dot(R_body_imu_ * imu.angular_velocity_radps);
}

/// Returns the sprocket speeds, left and right, rad/s. If one track exceeds its limit, both are scaled to keep the
/// curvature.
std::array<double, 2> TrackController::sprocket_speeds(double speed_mps, double yaw_rate_radps) const {
  const double half_gauge_m = settings_.effective_gauge_factor * tracks_.gauge_m / 2.0;
  const double left = speed_mps - yaw_rate_radps * half_gauge_m, right = speed_mps + yaw_rate_radps * half_gauge_m;
  const double scale =
      std::max({1.0, std::abs(left) / settings_.max_speed_mps, std::abs(right) / settings_.max_speed_mps});
  return {left / scale / tracks_.sprocket_radius_m, right / scale / tracks_.sprocket_radius_m};
}

/// Closes the brake after both sprockets have been at rest without command; opens it on command only.
void TrackController::update_brake() {
  const bool is_still = std::abs(speed_controllers_[0].speed_radps()) < kRestSprocket_radps &&
                        std::abs(speed_controllers_[1].speed_radps()) < kRestSprocket_radps;
  idle_s_ = is_commanded_to_rest() && (is_still || is_brake_closed_) ? idle_s_ + tick_s_ : 0.0;
  is_brake_closed_ = idle_s_ > settings_.brake_delay_s;
}

bool TrackController::is_commanded_to_rest() const {
  return std::abs(speed_mps_) < kRestSpeed_mps && std::abs(yaw_rate_radps_) < kRestRate_radps;
}

/// Integrates the "up" direction with the gyroscope and corrects it slowly by the accelerometer.
void TrackController::detect_fall(const Imu& imu) {
  age_s_ += tick_s_;
  const Eigen::Vector3d rate = R_body_imu_ * imu.angular_velocity_radps;
  const Eigen::Vector3d force = R_body_imu_ * imu.linear_acceleration_mps2;
  up_in_body_ += tick_s_ * up_in_body_.cross(rate);
  const double gain = age_s_ < kLevelSettling_s ? 10.0 : kLevelingRate_per_s;
  if (force.norm() > 1.0) up_in_body_ += gain * tick_s_ * (force.normalized() - up_in_body_);
  up_in_body_.normalize();
  fallen_s_ = up_in_body_.z() < kFallenCosine ? fallen_s_ + tick_s_ : 0.0;
}

}  // namespace patrol::sim
