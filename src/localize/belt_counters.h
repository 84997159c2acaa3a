#pragma once

#include <optional>

#include "core/sensors/registry.h"

namespace patrol::localize {

/// Speed of the two belts over the robot's body, by their counters; forwards is positive.
struct TrackSpeed {
  double left_mps = 0.0;
  double right_mps = 0.0;

  double mean_mps() const { return 0.5 * (left_mps + right_mps); }
  double difference_mps() const { return right_mps - left_mps; }
};

/// What two readings of the counters say.
struct BeltInterval {
  Time start{}, end{};
  TrackSpeed speed{};
  TrackSpeed smooth{};             ///< over the last tenth of a second or so
  double acceleration_mps2 = 0.0;  ///< of the smooth mean speed, smoothed again: nearly free of the counters' steps
  double step_mps = 0.0;           ///< speed of one tick in the interval

  double dt_s() const { return to_seconds(end - start); }
  Time middle() const { return start + (end - start) / 2; }
};

/// Speeds of the belts from the running counts of their Hall sensors.
class BeltCounters {
 public:
  struct Settings {
    double metres_per_tick;
    double max_acceleration_mps2;  ///< beyond, the counts are not believed (a counter has started anew) until they last
  };
  explicit BeltCounters(const Settings& settings) : settings_(settings) {}

  /// Stamps must grow. None at the first reading, after a long gap, and where the counts cannot be believed.
  std::optional<BeltInterval> add(const TrackTicks& ticks);

  /// No tick has come for a while.
  bool stand() const { return stand_since_ && last_ && last_->stamp - *stand_since_ >= kStandstill; }
  /// Since when; only while they stand.
  Time stand_since() const { return *stand_since_; }
  /// The newest reading that was used.
  const std::optional<TrackTicks>& last() const { return last_; }

  static constexpr Time kStandstill = std::chrono::milliseconds(300);

 private:
  bool is_believable(const BeltInterval& interval);

  Settings settings_;
  std::optional<TrackTicks> last_;
  std::optional<Time> stand_since_;
  std::optional<TrackSpeed> smooth_;
  double acceleration_mps2_ = 0.0;
  std::optional<Time> disbelieved_since_;
};

}  // namespace patrol::localize
