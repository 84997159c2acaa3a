#pragma once

#include "core/settings.h"
#include "stack/sensors/clock_monitor_settings.h"

namespace patrol::stack {

/// Settings of the sensor monitor. The age of a reading is counted from its stamp, less the slow drift of its clock, so
/// late readings count as missing.
struct SensorMonitorSettings {
  double lidar_timeout_s = 0.6;            ///< age limit of messages of lidars and the depth camera
  double proprioception_timeout_s = 0.15;  ///< age limit of messages of IMU, encoders and foot contacts
  double instrument_timeout_s = 5.0;       ///< age limit of messages of instruments, GNSS, UWB and sonar
  double max_clock_lead_s = 0.05;          ///< lead of a stamp over the present time above which the clock is wrong
  /// Relative rate error of a clock up to which stamps may drift from the present time without an error: quartz
  /// oscillator.
  double max_clock_drift = 1e-4;
  double frozen_path_m = 0.1;  ///< distance traveled during which the readings of a frozen sensor are bitwise identical
  /// Rotation of the robot during which the readings of a frozen sensor are bitwise identical.
  double frozen_turn_rad = 0.1;
  int frozen_repeats = 3;         ///< minimum number of repeated readings
  double abort_timeout_s = 60.0;  ///< time unable to drive after which the mission is aborted
  ClockMonitorSettings lidar_clock;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lidar_timeout_s", self.lidar_timeout_s, at_least(0.05));
    visit("proprioception_timeout_s", self.proprioception_timeout_s, at_least(0.01));
    visit("instrument_timeout_s", self.instrument_timeout_s, at_least(0.05));
    visit("max_clock_lead_s", self.max_clock_lead_s, at_least(0.0));
    visit("max_clock_drift", self.max_clock_drift, between(0.0, 0.01));
    visit("frozen_path_m", self.frozen_path_m, at_least(0.01));
    visit("frozen_turn_rad", self.frozen_turn_rad, at_least(0.01));
    visit("frozen_repeats", self.frozen_repeats, between(1, 1000));
    visit("abort_timeout_s", self.abort_timeout_s, at_least(1.0));
    visit("lidar_clock", self.lidar_clock);
  }
};

}  // namespace patrol::stack
