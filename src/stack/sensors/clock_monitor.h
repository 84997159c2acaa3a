#pragma once

#include <deque>
#include <optional>

#include "core/time.h"
#include "localize/calibration/time_offset_estimator.h"
#include "stack/sensors/clock_monitor_settings.h"
#include "stack/sensors/sensor_change.h"

namespace patrol::stack {

/// Estimated time offset between lidar stamps and odometry.
struct LidarClock {
  double offset_s = 0.0;     ///< positive: stamps are late
  double noise_std_s = 0.0;  ///< standard deviation without the lag of odometry
  int num_steps = 0;         ///< number of steps of the offset since the start
};

/// Returns the clock by the estimated time offset, which has changed by `num_steps` steps.
LidarClock lidar_clock_by(const localize::TimeOffset& offset, int num_steps);

/// Monitor of the lidar's clock. Reports an offset from odometry that exceeds a limit with confidence. An offset that
/// is stable and small enough is corrected, and the robot goes on. The robot must not drive with an offset that is too
/// large to be corrected, nor with one that changes by steps again and again.
///
/// The mean lag of odometry is removed. The confidence is that of the noise of the estimate alone: with the standard
/// deviation of the lag (1.5 ms), which never decreases, a limit of 5 ms would be one of 9.5 ms. With the noise of 20 s
/// of walking (0.3 ms), offsets are reported from 6 ms on. Errors of the IMU change the lag by 1 to 2 ms between robots
/// and headings: an offset of 4 ms is reported for some of them. An as-built lidar may exceed the limit: its offset is
/// the difference of two clocks of +-4 ms with a drift of 40 ppm.
class ClockMonitor {
 public:
  explicit ClockMonitor(const ClockMonitorSettings& settings) : settings_(settings) {}

  /// Returns the change since the last step, if any.
  std::optional<SensorChange> step(Time now, const LidarClock& against_odometry);
  bool can_drive() const { return state_ != State::kTooLarge && state_ != State::kUnstable; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(state_, num_steps_, steps_);
  }

 private:
  enum class State { kFine, kCorrected, kTooLarge, kUnstable };
  State state_of(const LidarClock& clock) const;

  ClockMonitorSettings settings_;
  State state_ = State::kFine;
  int num_steps_ = 0;
  std::deque<Time> steps_;  ///< times of the clock steps of the last `step_window_s`
};

}  // namespace patrol::stack
