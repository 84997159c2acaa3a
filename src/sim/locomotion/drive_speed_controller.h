#pragma once

#include <cstdint>

#include "sim/locomotion/drive_motor.h"

namespace patrol::sim {

/// Gains of a speed controller of a drive.
struct DriveSpeedGains {
  double kp_nms;                    ///< torque per rad/s of speed error
  double ki_nm;                     ///< torque per rad of lag angle
  double kd_nms2;                   ///< torque per rad/s2 of acceleration error
  double observer_bandwidth_radps;  ///< bandwidth of the speed observer on the counts
};

/// PID speed controller of one sprocket or wheel, with the counts of its encoder as the only measurement. The integral
/// of the speed error is the lag angle, known to one count. A tracking loop on the counter (second-order observer,
/// critically damped) estimates speed and acceleration.
class DriveSpeedController {
 public:
  DriveSpeedController(const DriveSpeedGains& gains, const DriveMotor& motor, double ticks_per_rad, double tick_s);

  /// Returns the torque for one tick, N m behind the gear, within the limits of the motor.
  double step(double requested_radps, std::int64_t count);

  /// Resets the lag angle.
  void reset();

  double speed_radps() const { return speed_radps_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(has_started_, angle_rad_, speed_radps_, acceleration_radps2_, last_requested_radps_, lag_rad_,
            last_angle_rad_);
  }

 private:
  void observe(double angle_rad);

  DriveSpeedGains gains_;
  DriveMotor motor_;
  double ticks_per_rad_, tick_s_;
  bool has_started_ = false;
  double angle_rad_ = 0.0, speed_radps_ = 0.0, acceleration_radps2_ = 0.0;  ///< estimates of the observer
  double last_requested_radps_ = 0.0;
  double lag_rad_ = 0.0;
  double last_angle_rad_ = 0.0;  ///< angle of the last count
};

}  // namespace patrol::sim
