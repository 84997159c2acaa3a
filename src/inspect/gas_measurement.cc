#include "inspect/gas_measurement.h"

#include <cmath>

namespace patrol::inspect {

void GasMeasurement::add(const GasReading& reading) {
  if (reading.stamp <= last_stamp_) return;
  if (!std::isfinite(reading.column_ppm_m) || !std::isfinite(reading.path_length_m)) return;
  last_stamp_ = reading.stamp;
  ++count_;
  const double deviation = reading.column_ppm_m - mean_ppm_m_;
  mean_ppm_m_ += deviation / count_;
  sum_of_squares_ += deviation * (reading.column_ppm_m - mean_ppm_m_);
  sum_of_lengths_m_ += reading.path_length_m;
}

double GasMeasurement::standard_error_ppm_m() const {
  return count_ < 2 ? 0.0 : std::sqrt(sum_of_squares_ / (count_ - 1) / count_);
}

std::optional<double> GasMeasurement::beam_m() const {
  if (count_ == 0) return std::nullopt;
  return sum_of_lengths_m_ / count_;
}

}  // namespace patrol::inspect
