#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/sensors/registry.h"

namespace patrol::sim {

/// Returns the air pressure `height_m` above the world's origin: troposphere of the International Standard Atmosphere
/// (ISO 2533) with the settings' pressure and temperature at sea level.
double air_pressure_pa(const BarometerSettings& settings, double height_m);

/// Barometer: reading = pressure + offset + temperature coefficient * warming + drift + noise, quantized. Not modeled:
/// wind, tunnel ventilation, weather beyond the drift.
class Barometer {
 public:
  Barometer(const BarometerSettings& settings, std::uint64_t seed);

  /// Takes reading number `index`, counted without gaps, `height_m` above the world's origin.
  FluidPressure read(double height_m, Time now, std::uint64_t index);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(drift_pa_);
  }

 private:
  BarometerSettings settings_;
  double offset_pa_, coefficient_pa_per_k_;  ///< constants of this sensor
  double correlation_;                       ///< correlation of the drift between consecutive readings
  double drift_pa_ = 0.0;
  RandomStream noise_, drift_;
};

}  // namespace patrol::sim
