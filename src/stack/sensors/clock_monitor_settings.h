#pragma once

#include "core/settings.h"

namespace patrol::stack {

/// Settings of the clock monitor, for the estimated time offset of the lidar.
struct ClockMonitorSettings {
  double max_offset_s = 0.005;  ///< offset above which the monitor reports it
  /// Mean lag of odometry behind its own stamps, which makes the lidar appear early: 1.0 and 1.1 ms for a nominal robot
  /// (two seeds). Probable cause, not tested: the rate of the simulated IMU is half a step of 2 ms old.
  double odometry_lag_s = 0.001;
  double sigma = 3.0;  ///< number of standard deviations by which an offset exceeds a limit before it is reported
  /// Largest offset that the stack corrects; at a larger one the robot stops: two clocks of 20 ppm reach 0.144 s in an
  /// hour.
  double max_corrected_offset_s = 0.15;
  int max_steps = 2;            ///< number of steps of the offset within `step_window_s` above which the robot stops
  double step_window_s = 60.0;  ///< time in which steps of the offset are counted

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_offset_s", self.max_offset_s, at_least(0.0));
    visit("odometry_lag_s", self.odometry_lag_s, between(-1.0, 1.0));
    visit("sigma", self.sigma, between(0.0, 100.0));
    visit("max_corrected_offset_s", self.max_corrected_offset_s, at_least(0.0));
    visit("max_steps", self.max_steps, between(0, 1000));
    visit("step_window_s", self.step_window_s, at_least(0.0));
  }
};

}  // namespace patrol::stack
