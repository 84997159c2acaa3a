#pragma once

#include <deque>
#include <optional>

#include "core/time.h"

namespace patrol::localize {

/// Evidence of slip: a speed change of the tracks that differs from that of the accelerometer, within about a second.
struct SlipEvidence {
  double forward_mps = 0.0;       ///< body speed: estimate at the start of the window plus integrated acceleration
  double disagreement_mps = 0.0;  ///< tracks minus accelerometer
  double duration_s = 0.0;
};

/// Slip detector: compares the speed change of the tracks with the integrated IMU acceleration over a sliding window.
/// An IMU cannot distinguish rest from steady motion. It does show whether the body accelerated together with the
/// tracks.
class SlipDetector {
 public:
  struct Settings {
    double window_s;
    double threshold_mps;  ///< minimum disagreement; increased on a rough ride and by the error of the acceleration
  };
  explicit SlipDetector(const Settings& settings) : settings_(settings) {}

  /// Adds an IMU step: forward acceleration over the step that ends at `stamp`, without gravity. `std_mps2`: standard
  /// deviation of its lasting error, from accelerometer bias and tilt.
  void add_acceleration(Time stamp, double dt_s, double acceleration_mps2, double std_mps2 = 0.0);
  /// Adds a track reading, not newer than the newest acceleration: mean track speed and estimated body speed. Returns
  /// evidence if there is slip.
  std::optional<SlipEvidence> add_speed(Time stamp, double tracks_mps, double estimated_mps);
  /// Returns the bound of the error from roughness of the speed that is integrated from the accelerations since the
  /// start of the window of the last evidence: a bump leaves the speed of the body uncertain. Zero without evidence.
  double roughness_bound_mps() const;
  /// Starts a new window.
  void reset();

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(sums_, readings_, evidence_start_, last_acceleration_);
  }

 private:
  struct Sum {
    Time stamp{};
    double speed_mps = 0.0;        ///< integrated acceleration
    double variance_m2ps2 = 0.0;   ///< accumulated variance of the integral, from the roughness of the acceleration
    double lasting_std_mps = 0.0;  ///< integrated standard deviation of the lasting error
  };
  struct Reading {
    Sum sum;
    double tracks_mps = 0.0;
    double estimated_mps = 0.0;
  };
  std::optional<Sum> sum_at(Time stamp) const;
  static double roughness_bound_mps(const Sum& from, const Sum& to);

  Settings settings_;
  std::deque<Sum> sums_;
  std::deque<Reading> readings_;
  std::optional<Sum> evidence_start_;  ///< sum at the start of the window of the last evidence
  double last_acceleration_ = 0.0;
};

}  // namespace patrol::localize
