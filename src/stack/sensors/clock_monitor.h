#pragma once

#include <deque>
#include <optional>

#include "core/time.h"
#include "stack/sensors/clock_monitor_settings.h"
#include "stack/sensors/sensor_change.h"

namespace patrol::stack {

/// Estimated time offset between lidar stamps and odometry.
struct LidarClock {
  double offset_s = 0.0;  ///< positive: stamps are late
  double std_s = 0.0;
  int num_steps = 0;  ///< steps of the offset so far
};

/// Monitor of the lidar's clock. Reports an offset from odometry that exceeds a limit with confidence. An offset that
/// is stable and small enough is corrected, and the robot goes on. The robot must not drive with an offset that is too
/// large to be corrected, nor with one that changes by steps again and again.
class ClockMonitor {
 public:
  explicit ClockMonitor(const ClockMonitorSettings& settings) : settings_(settings) {}

  /// Returns the change since the last step, if any.
  std::optional<SensorChange> step(Time now, const LidarClock& clock);
  bool can_drive() const { return state_ != State::kTooLarge && state_ != State::kUnstable; }

 private:
  enum class State { kFine, kCorrected, kTooLarge, kUnstable };
  State state_of(const LidarClock& clock) const;

  ClockMonitorSettings settings_;
  State state_ = State::kFine;
  int num_steps_ = 0;
  std::deque<Time> steps_;  ///< of the last `step_window_s`
};

}  // namespace patrol::stack
