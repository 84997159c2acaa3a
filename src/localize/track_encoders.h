#pragma once

#include <cstdint>
#include <optional>

#include "core/sensors/registry.h"

namespace patrol::localize {

/// Running counts of the encoders of tracks or wheels: those of the two sides, for mecanum wheels those of the lateral
/// motion, and for mecanum wheels and driven steered wheels those of their contradictions.
struct DriveTicks : TrackTicks {
  /// Counts of the sides without lateral motion.
  DriveTicks(const TrackTicks& sides) : TrackTicks(sides) {}  // NOLINT(google-explicit-constructor)
  DriveTicks(Time time, std::int64_t left_count, std::int64_t right_count, std::int64_t lateral_count = 0,
             std::int64_t residual_count = 0)
      : TrackTicks{.stamp = time, .left = left_count, .right = right_count},
        lateral(lateral_count),
        residual(residual_count) {}

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(stamp, left, right, lateral, residual);
  }

  std::int64_t lateral = 0;   ///< counts of the motion to the left
  std::int64_t residual = 0;  ///< counts of the motion that only slip explains (WheelMotion::residual_mps,
                              ///< SteeredWheels)
};

/// Speed of the two tracks relative to the robot's body, from the track encoders; forward is positive.
struct TrackSpeed {
  double left_mps = 0.0;
  double right_mps = 0.0;
  double lateral_mps = 0.0;   ///< lateral speed of the robot by mecanum wheels, positive to the left
  double residual_mps = 0.0;  ///< speed of mecanum or steered wheels that only slip explains

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
  double lateral_acceleration_mps2 = 0.0;  ///< derivative of the smoothed lateral speed, smoothed again
  double step_mps = 0.0;                   ///< speed of one tick in the interval

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
  std::optional<EncoderInterval> add(const DriveTicks& ticks);

  /// Returns the speeds from the last reading to `ticks`, without adding it. Returns nullopt before the first reading
  /// and if the speed of a track changes more than it can, as when the counters restart.
  std::optional<TrackSpeed> speed_until(const DriveTicks& ticks) const;

  /// Returns whether there was no tick for at least `kStandstill`.
  bool is_stationary() const { return stationary_since_ && last_ && last_->stamp - *stationary_since_ >= kStandstill; }
  /// Returns the start of the standstill; valid only while `is_stationary()` is true.
  Time stationary_since() const { return *stationary_since_; }
  /// Returns the most recent reading.
  const std::optional<DriveTicks>& last() const { return last_; }

  static constexpr Time kStandstill = std::chrono::milliseconds(300);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_, stationary_since_, smooth_, acceleration_mps2_, lateral_acceleration_mps2_, rejected_since_);
  }

 private:
  EncoderInterval interval_from(const DriveTicks& before, const DriveTicks& ticks) const;
  double max_change_mps(const EncoderInterval& interval) const;
  bool accept_change(const EncoderInterval& interval);

  Settings settings_;
  std::optional<DriveTicks> last_;
  std::optional<Time> stationary_since_;
  std::optional<TrackSpeed> smooth_;
  double acceleration_mps2_ = 0.0, lateral_acceleration_mps2_ = 0.0;
  std::optional<Time> rejected_since_;
};

}  // namespace patrol::localize
