#pragma once

#include <optional>

#include "core/sensors/registry.h"

namespace patrol::localize {

/// Speed of the two tracks relative to the robot's body, from the track encoders; forward is positive.
struct TrackSpeed {
  double left_mps = 0.0;
  double right_mps = 0.0;

  double mean_mps() const { return 0.5 * (left_mps + right_mps); }
  double difference_mps() const { return right_mps - left_mps; }
};

/// Motion of the tracks between two encoder readings.
struct EncoderInterval {
  Time start{}, end{};
  TrackSpeed speed{};
  TrackSpeed smooth{};  ///< smoothed with a time constant of 0.1 s
  /// Derivative of the smoothed mean speed, smoothed again; nearly free of quantization.
  double acceleration_mps2 = 0.0;
  double step_mps = 0.0;  ///< speed of one tick in the interval

  double dt_s() const { return to_seconds(end - start); }
  Time middle() const { return start + (end - start) / 2; }
};

/// Track encoders: track speeds from the running counts of the Hall sensors.
class TrackEncoders {
 public:
  struct Settings {
    double meters_per_tick;
    double max_acceleration_mps2;  ///< larger accelerations are rejected as a counter restart, unless they persist
  };
  explicit TrackEncoders(const Settings& settings) : settings_(settings) {}

  /// Adds a reading; stamps must increase. Returns nullopt for the first reading, after a long gap, and for implausible
  /// counts.
  std::optional<EncoderInterval> add(const TrackTicks& ticks);

  /// Returns whether there was no tick for at least `kStandstill`.
  bool is_stationary() const { return stationary_since_ && last_ && last_->stamp - *stationary_since_ >= kStandstill; }
  /// Returns the start of the standstill; valid only while `is_stationary()` is true.
  Time stationary_since() const { return *stationary_since_; }
  /// Returns the most recent reading.
  const std::optional<TrackTicks>& last() const { return last_; }

  static constexpr Time kStandstill = std::chrono::milliseconds(300);

 private:
  bool accept_change(const EncoderInterval& interval);

  Settings settings_;
  std::optional<TrackTicks> last_;
  std::optional<Time> stationary_since_;
  std::optional<TrackSpeed> smooth_;
  double acceleration_mps2_ = 0.0;
  std::optional<Time> rejected_since_;
};

}  // namespace patrol::localize
