#pragma once

#include <optional>

#include "core/sensors/registry.h"

namespace patrol::inspect {

/// Statistics of the methane columns measured while the robot is stationary and aims at a target.
class GasMeasurement {
 public:
  /// Adds a reading. Readings without a return (the beam has no finite length) and older readings are ignored.
  void add(const GasReading& reading);

  int count() const { return count_; }
  double mean_ppm_m() const { return mean_ppm_m_; }
  /// Returns the standard error of the mean; 0 for fewer than two readings.
  double standard_error_ppm_m() const;
  /// Returns the mean beam length of the readings; nullopt if there are none.
  std::optional<double> beam_m() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_stamp_, count_, mean_ppm_m_, sum_of_squares_, sum_of_lengths_m_);
  }

 private:
  Time last_stamp_ = Time::min();
  int count_ = 0;
  double mean_ppm_m_ = 0.0;
  double sum_of_squares_ = 0.0;  ///< sum of squared deviations from the mean [Welford62]
  double sum_of_lengths_m_ = 0.0;
};

}  // namespace patrol::inspect
