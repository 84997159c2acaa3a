#include "sim/locomotion/drive_speed_controller.h"

#include <algorithm>

namespace patrol::sim {

DriveSpeedController::DriveSpeedController(const DriveSpeedGains& gains, const DriveMotor& motor, double ticks_per_rad,
                                           double tick_s)
    : gains_(gains), motor_(motor), ticks_per_rad_(ticks_per_rad), tick_s_(tick_s) {}

double DriveSpeedController::step(double requested_radps, std::int64_t count) {
  const double angle_rad = (static_cast<double>(count) + 0.5) / ticks_per_rad_;  // a count represents the center of its
                                                                                 // interval
  observe(angle_rad);
  lag_rad_ += tick_s_ * requested_radps - (angle_rad - last_angle_rad_);
  const double requested_radps2 = (requested_radps - last_requested_radps_) / tick_s_;
  last_angle_rad_ = angle_rad;
  last_requested_radps_ = requested_radps;

  const double rest_nm =
      gains_.kp_nms * (requested_radps - speed_radps_) + gains_.kd_nms2 * (requested_radps2 - acceleration_radps2_);
  const double requested_nm = rest_nm + gains_.ki_nm * lag_rad_;
  const double torque_nm = motor_.feasible_torque_nm(requested_nm, speed_radps_);
  // Anti-windup: the integral never requests more than the motor's torque.
  const bool grows = (requested_nm - torque_nm) * lag_rad_ > 0.0;
  if (grows && gains_.ki_nm > 0.0) {
    const double useful_rad = (torque_nm - rest_nm) / gains_.ki_nm;
    lag_rad_ = std::clamp(useful_rad, std::min(lag_rad_, 0.0), std::max(lag_rad_, 0.0));
  }
  return torque_nm;
}

void DriveSpeedController::reset() {
  lag_rad_ = 0.0;
  last_requested_radps_ = 0.0;
}

void DriveSpeedController::observe(double angle_rad) {
  if (!has_started_) {
    has_started_ = true;
    angle_rad_ = last_angle_rad_ = angle_rad;
  }
  const double w = gains_.observer_bandwidth_radps;
  angle_rad_ += tick_s_ * speed_radps_;
  const double error_rad = angle_rad - angle_rad_;
  angle_rad_ += tick_s_ * 2.0 * w * error_rad;
  acceleration_radps2_ = w * w * error_rad;
  speed_radps_ += tick_s_ * acceleration_radps2_;
}

}  // namespace patrol::sim
