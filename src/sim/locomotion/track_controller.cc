#include "sim/locomotion/track_controller.h"

#include <algorithm>
#include <cmath>

namespace patrol::sim {
namespace {

constexpr double kRestSprocket_radps = 0.5;  // a single count back and forth appears as 0.3
constexpr double kBiasTime_s = 5.0;          // averaging time of the gyroscope bias at rest

DriveSpeedGains gains_of(const TrackDriveSettings& settings) {
  return {.kp_nms = settings.kp_nms,
          .ki_nm = settings.ki_nm,
          .kd_nms2 = settings.kd_nms2,
          .observer_bandwidth_radps = settings.observer_bandwidth_radps};
}

DriveMotor motor_of(const JointLimit& limit, const TrackDriveSettings& settings) {
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
          DriveSpeedController(gains_of(settings), motor_of(robot.joint_limits[0], settings), ticks_per_rad, tick_s),
          DriveSpeedController(gains_of(settings), motor_of(robot.joint_limits[1], settings), ticks_per_rad, tick_s)},
      ramp_({.speed_mps = settings.max_speed_mps,
             .yaw_rate_radps = settings.max_yaw_rate_radps,
             .acceleration_mps2 = settings.max_acceleration_mps2,
             .yaw_acceleration_radps2 = settings.max_yaw_acceleration_radps2},
            tick_s),
      fall_detector_(R_body_imu_, tick_s) {
  validate(settings, "track_drive");
}

TrackDriveCommand TrackController::step(const Imu& imu, const TrackTicks& ticks, const VelocityCommand& command) {
  fall_detector_.step(imu);
  ramp_.step(command);
  const std::array<double, 2> requested_radps = sprocket_speeds(ramp_.speed_mps(), corrected_yaw_rate(imu));
  TrackDriveCommand drive_command{.torque_nm = {speed_controllers_[0].step(requested_radps[0], ticks.left),
                                                speed_controllers_[1].step(requested_radps[1], ticks.right)}};
  update_brake();
  if (is_brake_closed_) {
    for (DriveSpeedController& regulator : speed_controllers_) regulator.reset();
    update_gyro_bias(imu);
    drive_command = {.is_brake_closed = true};
  }
  return drive_command;
}

/// Returns the yaw rate command for the kinematics such that the gyroscope measures the requested yaw rate.
double TrackController::corrected_yaw_rate(const Imu& imu) {
  if (!settings_.use_gyro) return ramp_.yaw_rate_radps();
  if (ramp_.is_at_rest()) {
    yaw_lag_rad_ = 0.0;
    return ramp_.yaw_rate_radps();
  }
  const double yaw_rate_error_radps = ramp_.yaw_rate_radps() - (measured_yaw_rate(imu) - gyro_bias_radps_);
  const double limit = settings_.max_gyro_correction_radps;
  const double gain = settings_.gyro_integral_per_s;
  if (gain > 0.0) yaw_lag_rad_ = std::clamp(yaw_lag_rad_ + tick_s_ * yaw_rate_error_radps, -limit / gain, limit / gain);
  return ramp_.yaw_rate_radps() +
         std::clamp(settings_.gyro_gain * yaw_rate_error_radps + gain * yaw_lag_rad_, -limit, limit);
}

/// Updates the gyroscope bias: mean over the first seconds at rest, running mean afterward.
void TrackController::update_gyro_bias(const Imu& imu) {
  bias_averaging_s_ = std::min(bias_averaging_s_ + tick_s_, kBiasTime_s);
  gyro_bias_radps_ += tick_s_ / bias_averaging_s_ * (measured_yaw_rate(imu) - gyro_bias_radps_);
}

double TrackController::measured_yaw_rate(const Imu& imu) const {
  return fall_detector_.up_in_body().dot(R_body_imu_ * imu.angular_velocity_radps);
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
  idle_s_ = ramp_.is_at_rest() && (is_still || is_brake_closed_) ? idle_s_ + tick_s_ : 0.0;
  is_brake_closed_ = idle_s_ > settings_.brake_delay_s;
}

}  // namespace patrol::sim
