#pragma once

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Reading of the open-path laser methane meter (TDLAS), which measures the gas column along its beam.
struct GasReading {
  Time stamp{};
  double column_ppm_m = 0.0;   ///< concentration integrated along the beam
  double path_length_m = 0.0;  ///< path length to the backscattering surface; +Inf if there is none
  double mean_mg_m3 = 0.0;     ///< mean concentration: column divided by path length, as mass of methane at 20 degC
                               ///< and 1 atm
};

/// Open-path laser methane meter with its beam along x. Defaults after the data sheet of Tokyo Gas Engineering's
/// LaserMethane mini: 1-50,000 ppm m, +-10 %, 10 Hz, 30 m.
struct TdlasSettings {
  bool enabled = true;                ///< presence of the sensor; false: no messages
  double rate_hz = 10.0;              ///< rate of the messages
  double noise_std_ppm_m = 10.0;      ///< standard deviation of the additive noise
  double relative_noise_std = 0.05;   ///< standard deviation of the noise, relative to the column
  double background_ppm = 1.9;        ///< methane in clean air
  double resolution_ppm_m = 1.0;      ///< step of the reported methane column
  double max_column_ppm_m = 50000.0;  ///< largest methane column that the meter reports
  double range_m = 30.0;              ///< largest length of the beam path
  double latency_s = 0.1;             ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 100.0));
    visit("noise_std_ppm_m", self.noise_std_ppm_m, at_least(0.0));
    visit("relative_noise_std", self.relative_noise_std, between(0.0, 1.0));
    visit("background_ppm", self.background_ppm, at_least(0.0));
    visit("resolution_ppm_m", self.resolution_ppm_m, at_least(0.0));
    visit("max_column_ppm_m", self.max_column_ppm_m, at_least(1.0));
    visit("range_m", self.range_m, between(0.1, 200.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<GasReading> {
  struct Settings {
    TdlasSettings tdlas;
  };
  static constexpr auto kSettings = &Settings::tdlas;
  static constexpr SensorInfo kInfo = {.name = "tdlas",
                                       .topic = "/gas",
                                       .ros_type = "patrol_msgs/msg/GasReading",
                                       .summary = "open-path laser methane meter",
                                       .frame = "tdlas",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "ppm m", .drift_per_s = 20.0, .outlier = 300.0}};

  static void add_to_reading(GasReading& gas, double offset_ppm_m) { gas.column_ppm_m += offset_ppm_m; }
};

}  // namespace patrol
