#pragma once

#include <cstdint>

#include "sim/locomotion/track_drive_settings.h"
#include "sim/locomotion/track_motor.h"

namespace patrol::sim {

/// PID speed controller of one sprocket, with Hall counts as its only measurement. The integral of the speed error is
/// the lag angle, known to one count. A tracking loop on the counter (second-order observer, critically damped)
/// estimates speed and acceleration.
class SprocketSpeedController {
 public:
  SprocketSpeedController(const TrackDriveSettings& settings, const TrackMotor& motor, double ticks_per_rad,
                          double tick_s);

  /// Returns the torque for one tick, N m at the sprocket, within the limits of the motor.
  double step(double requested_radps, std::int64_t count);

  /// Resets the lag angle.
  void reset();

  double speed_radps() const { return speed_radps_; }

 private:
  void observe(double angle_rad);

  TrackDriveSettings settings_;
  TrackMotor motor_;
  double ticks_per_rad_, tick_s_;
  bool has_started_ = false;
  double angle_rad_ = 0.0, speed_radps_ = 0.0, acceleration_radps2_ = 0.0;  ///< estimates of the observer
  double last_requested_radps_ = 0.0;
  double lag_rad_ = 0.0;
  double last_angle_rad_ = 0.0;  ///< angle of the last count
};

}  // namespace patrol::sim
