#pragma once

#include <optional>

#include "core/sensors/registry.h"

namespace patrol::inspect {

/// The methane columns read while the robot stands and aims.
class GasMeasurement {
 public:
  void add(const GasReading& reading);

  int count() const { return count_; }
  double mean_ppm_m() const { return mean_ppm_m_; }
  /// Of the mean; 0 for fewer than two readings.
  double standard_error_ppm_m() const;
  /// Mean length of the beam, where it met something.
  std::optional<double> beam_m() const;

 private:
  Time last_stamp_ = Time::min();
  int count_ = 0;
  double mean_ppm_m_ = 0.0;
  double sum_of_squares_ = 0.0;  ///< about the mean (Welford 1962)
  int num_echoes_ = 0;
  double sum_of_lengths_m_ = 0.0;
};

}  // namespace patrol::inspect
