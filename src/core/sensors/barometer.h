#pragma once

#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Static air pressure at `imu`; the barometer is in the IMU housing.
struct FluidPressure {
  Time stamp{};
  double pressure_pa = 0.0;
  double std_pa = 0.0;  ///< standard deviation of the noise, Pa
};

/// Barometer with the data of Bosch's BMP390 (data sheet BST-BMP390-DS002). Absolute accuracy of 50 Pa, relative
/// accuracy of 3 Pa and offset temperature coefficient of 0.6 Pa/K are read as two standard deviations each: of a
/// constant offset, of a slow drift and of the coefficient. Noise is 0.02 Pa rms and resolution 0.016 Pa at the highest
/// oversampling with its filter. The drift's correlation time and the warming of the housing are assumptions.
struct BarometerSettings {
  bool enabled = false;                               ///< presence of the sensor; false: no messages
  double rate_hz = 5.0;                               ///< rate of the messages
  double sea_level_pa = 101325.0;                     ///< pressure at sea level
  double sea_level_temperature_c = 15.0;              ///< air temperature at sea level
  double origin_altitude_m = 0.0;                     ///< altitude of the world's origin above sea level
  double noise_std_pa = 0.02;                         ///< standard deviation of the noise, Pa
  double offset_std_pa = 25.0;                        ///< standard deviation, over sensors, of the constant offset, Pa
  double drift_std_pa = 1.5;                          ///< standard deviation of the drift, a Gauss-Markov process, Pa
  double drift_correlation_time_s = 600.0;            ///< correlation time of the drift
  double temperature_coefficient_std_pa_per_k = 0.3;  ///< standard deviation, over sensors, of the change of the offset
                                                      ///< per kelvin
  double warming_k = 8.0;                             ///< final rise of the sensor's temperature above that at power-up
  double warming_time_s = 300.0;                      ///< time constant of the warming
  double resolution_pa = 0.016;                       ///< quantization step, Pa
  double latency_s = 0.05;                            ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 200.0));
    visit("sea_level_pa", self.sea_level_pa, between(80000.0, 110000.0));
    visit("sea_level_temperature_c", self.sea_level_temperature_c, between(-60.0, 60.0));
    visit("origin_altitude_m", self.origin_altitude_m, between(-500.0, 9000.0));
    visit("noise_std_pa", self.noise_std_pa, between(0.0, 1000.0));
    visit("offset_std_pa", self.offset_std_pa, between(0.0, 10000.0));
    visit("drift_std_pa", self.drift_std_pa, between(0.0, 1000.0));
    visit("drift_correlation_time_s", self.drift_correlation_time_s, between(0.1, 1e6));
    visit("temperature_coefficient_std_pa_per_k", self.temperature_coefficient_std_pa_per_k, between(0.0, 100.0));
    visit("warming_k", self.warming_k, between(0.0, 60.0));
    visit("warming_time_s", self.warming_time_s, between(0.1, 1e5));
    visit("resolution_pa", self.resolution_pa, between(0.0, 100.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<FluidPressure> {
  struct Settings {
    BarometerSettings barometer;
  };
  static constexpr auto kSettings = &Settings::barometer;
  static constexpr SensorInfo kInfo = {.name = "barometer",
                                       .topic = "/imu/pressure",
                                       .ros_type = "sensor_msgs/msg/FluidPressure",
                                       .summary = "barometer",
                                       .frame = "imu",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "Pa", .drift_per_s = 5.0, .outlier = 200.0}};

  static void add_to_reading(FluidPressure& reading, double offset_pa) { reading.pressure_pa += offset_pa; }
  static std::vector<ErrorSource> error_sources() {
    return {{"barometer: noise", {"sensors.barometer.noise_std_pa=0", "sensors.barometer.resolution_pa=0"}},
            {"barometer: offset", {"sensors.barometer.offset_std_pa=0"}},
            {"barometer: drift and temperature",
             {"sensors.barometer.drift_std_pa=0", "sensors.barometer.temperature_coefficient_std_pa_per_k=0"}}};
  }
};

}  // namespace patrol
