#include "stack/sensors/clock_monitor.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace patrol::stack {
namespace {

/// Describes an offset: "20.1 ms early".
std::string describe(double offset_s) {
  return fmt::format("{:.1f} ms {}", 1e3 * std::abs(offset_s), offset_s < 0.0 ? "early" : "late");
}

}  // namespace

LidarClock lidar_clock_by(const localize::TimeOffset& offset, int num_steps) {
  return {.offset_s = offset.value_s, .noise_std_s = offset.noise_std_s, .num_steps = num_steps};
}

std::optional<SensorChange> ClockMonitor::step(Time now, const LidarClock& against_odometry) {
  LidarClock clock = against_odometry;
  clock.offset_s += settings_.odometry_lag_s;
  for (; num_steps_ < clock.num_steps; ++num_steps_) steps_.push_back(now);
  while (!steps_.empty() && now - steps_.front() > from_seconds(settings_.step_window_s)) steps_.pop_front();
  const State state = state_of(clock);
  if (std::exchange(state_, state) == state) return std::nullopt;
  SensorChange change{.sensor = "lidar", .has_recovered = state == State::kFine, .text = {}};
  switch (state) {
    case State::kFine:
      change.text = "Sensor lidar has stamps that agree with odometry again.";
      break;
    case State::kCorrected:
      change.text = fmt::format("Sensor lidar has stamps {} against odometry: corrected.", describe(clock.offset_s));
      break;
    case State::kTooLarge:
      change.text =
          fmt::format("Sensor lidar has stamps {} against odometry, more than can be corrected: robot stopped.",
                      describe(clock.offset_s));
      break;
    case State::kUnstable:
      change.text = "Sensor lidar has stamps that change by steps against odometry: robot stopped.";
      break;
  }
  return change;
}

ClockMonitor::State ClockMonitor::state_of(const LidarClock& clock) const {
  if (static_cast<int>(steps_.size()) > settings_.max_steps) return State::kUnstable;
  const double margin_s = settings_.sigma * clock.noise_std_s;
  const double certain_s = std::abs(clock.offset_s) - margin_s;
  if (certain_s > settings_.max_corrected_offset_s) return State::kTooLarge;
  if (certain_s > settings_.max_offset_s) return State::kCorrected;
  // Keep a reported state until the offset is below the limit with the same confidence.
  if (state_ != State::kFine && std::abs(clock.offset_s) + margin_s > settings_.max_offset_s)
    return state_ == State::kUnstable ? State::kCorrected : state_;
  return State::kFine;
}

}  // namespace patrol::stack
