#pragma once

#include <deque>
#include <optional>

#include "localize/calibration/calibration_scan.h"
#include "localize/calibration/clustered_least_squares.h"
#include "localize/calibration/time_offset_estimator_settings.h"

namespace patrol::localize {

/// Time offset of the lidar with its uncertainty.
struct TimeOffset {
  double value_s = 0.0, std_s = 0.0;
  double noise_std_s = 0.0;  ///< part of `std_s` by the errors of the comparisons, without the lag of odometry
  double drift_s_per_s = 0.0, drift_std_s_per_s = 0.0;
};

/// Returns whether an estimate is precise enough to replace the applied offset: its standard deviation is at most
/// `max_std_s`, or it differs from the applied offset by more than five of them. Far from the applied offset, the
/// standard deviation decreases only once the offset is corrected, because the comparison of scans is linearized.
bool is_applicable(const TimeOffset& estimate, double applied_s, double max_std_s);

/// Estimator of the time offset between lidar stamps and odometry, and of its drift.
///
/// The motion between consecutive scans by matching is compared with odometry: an offset e changes the residual by e
/// times the change of the velocity. The offset is therefore observable only while yaw rate or velocity change.
///
/// A second estimate from the newest scans alone detects steps of the offset; the estimate then restarts.
class TimeOffsetEstimator {
 public:
  explicit TimeOffsetEstimator(const TimeOffsetEstimatorSettings& settings);

  /// Adds a scan; scans of different local maps and scans after a gap are not compared.
  void add(const CalibrationScan& scan);

  /// Returns the estimate at an instant.
  TimeOffset at(Time stamp) const;
  /// Returns how many times the offset has changed by a step.
  int num_steps() const { return num_steps_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(filter_, last_, origin_, recent_, num_steps_);
  }

 private:
  /// Scalar normal equation of one comparison for the offset alone.
  struct Term {
    Time stamp{};
    double information = 0.0, information_offset = 0.0;
  };
  void detect_step(const LinearMeasurement& measurement);

  TimeOffsetEstimatorSettings settings_;
  ClusteredLeastSquares filter_;  ///< offset at `origin_`, drift
  std::optional<CalibrationScan> last_;
  std::optional<Time> origin_;
  std::deque<Term> recent_;
  int num_steps_ = 0;
};

}  // namespace patrol::localize
