#pragma once

#include <deque>
#include <optional>

#include "core/time.h"

namespace patrol::localize {

/// The belts gained or lost speed that the accelerometer has not felt (or the other way round) within the last second or so.
struct SlipEvidence {
  double forward_mps = 0.0;     ///< what the body does by the accelerometer, from the speed that was believed before
  double disagreement_mps = 0.0;  ///< belts less accelerometer
  double duration_s = 0.0;
};

/// Compares the change of the belts' speed with the acceleration that the IMU has summed up over a sliding window. An IMU cannot
/// tell rest from steady motion, but it can tell that belts which have just run up have not taken the body along.
class SlipWatch {
 public:
  struct Settings {
    double window_s;
    double threshold_mps;  ///< least disagreement that counts; more where the ride is rough
  };
  explicit SlipWatch(const Settings& settings) : settings_(settings) {}

  /// At each IMU step: forward acceleration over the step that ends at `stamp`, gravity removed.
  void add_acceleration(Time stamp, double dt_s, double acceleration_mps2);
  /// At each reading of the belts, not newer than the newest acceleration: their mean speed, and the body's believed one.
  std::optional<SlipEvidence> add_speed(Time stamp, double belts_mps, double believed_mps);
  /// Starts a new window.
  void reset();

 private:
  struct Sum {
    Time stamp{};
    double speed_mps = 0.0;     ///< acceleration summed up
    double variance_m2ps2 = 0.0;  ///< of that sum, by the roughness of what was summed; summed up
  };
  struct Reading {
    Sum sum;
    double belts_mps = 0.0;
    double believed_mps = 0.0;
  };
  std::optional<Sum> sum_at(Time stamp) const;

  Settings settings_;
  std::deque<Sum> sums_;
  std::deque<Reading> readings_;
  double last_acceleration_ = 0.0;
};

}  // namespace patrol::localize
