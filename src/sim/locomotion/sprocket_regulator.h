#pragma once

#include <cstdint>

#include "sim/locomotion/track_drive_settings.h"
#include "sim/locomotion/track_motor.h"

namespace patrol::sim {

/// Holds one sprocket to a speed, from Hall ticks alone: a PID regulator on the speed. The integral of the speed's error is the
/// angle that the sprocket is behind, and that the counter knows to a tick. Speed and acceleration come from a tracking loop on
/// the counter (a second-order observer, critically damped).
class SprocketRegulator {
 public:
  SprocketRegulator(const TrackDriveSettings& settings, const TrackMotor& motor, double ticks_per_rad, double tick_s);

  /// One tick; N m at the sprocket, within what the motor can give.
  double step(double wanted_radps, std::int64_t count);

  /// Forgets how far behind it is.
  void let_go();

  double speed_radps() const { return speed_radps_; }

 private:
  void observe(double angle_rad);

  TrackDriveSettings settings_;
  TrackMotor motor_;
  double ticks_per_rad_, tick_s_;
  bool has_started_ = false;
  double angle_rad_ = 0.0, speed_radps_ = 0.0, acceleration_radps2_ = 0.0;  ///< observed
  double last_wanted_radps_ = 0.0;
  double behind_rad_ = 0.0;
  double last_angle_rad_ = 0.0;  ///< counted
};

}  // namespace patrol::sim
