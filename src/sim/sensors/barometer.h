#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/sensors/registry.h"

namespace patrol::sim {

/// Pressure of the air `height_m` above the world's origin: the troposphere of the International Standard Atmosphere
/// (ISO 2533), with the settings' pressure and temperature at sea level.
double air_pressure_pa(const BarometerSettings& settings, double height_m);

/// Barometer: reading = pressure + offset + temperature coefficient * warming + drift + noise, in whole steps. Not
/// modeled: wind, the ventilation of a tunnel, weather beyond the drift.
class Barometer {
 public:
  Barometer(const BarometerSettings& settings, std::uint64_t seed);

  /// Takes reading number `index` of consecutive ones, `height_m` above the world's origin.
  FluidPressure read(double height_m, Time now, std::uint64_t index);

 private:
  BarometerSettings settings_;
  double offset_pa_, coefficient_pa_per_k_;  ///< of this sensor
  double keep_;                              ///< correlation of the drift from reading to reading
  double drift_pa_ = 0.0;
  RandomStream noise_, drift_;
};

}  // namespace patrol::sim
