#include "sim/sensors/barometer.h"

#include <cmath>

#include "sim/sensors/sensor.h"

namespace patrol::sim {

double air_pressure_pa(const BarometerSettings& settings, double height_m) {
  constexpr double kLapse_Kpm = 0.0065;
  constexpr double kStandardGravity_mps2 = 9.80665, kMolarMass_kgpmol = 0.0289644, kGas_JpmolK = 8.31432;
  constexpr double kExponent = kStandardGravity_mps2 * kMolarMass_kgpmol / (kGas_JpmolK * kLapse_Kpm);
  const double temperature_k = settings.sea_level_temperature_c + 273.15;
  const double altitude_m = settings.origin_altitude_m + height_m;
  return settings.sea_level_pa * std::pow(1.0 - kLapse_Kpm * altitude_m / temperature_k, kExponent);
}

Barometer::Barometer(const BarometerSettings& settings, std::uint64_t seed)
    : settings_(settings),
      offset_pa_(settings.offset_std_pa * RandomStream(seed, "barometer/offset").normal(0)),
      coefficient_pa_per_k_(settings.temperature_coefficient_std_pa_per_k *
                            RandomStream(seed, "barometer/temperature").normal(0)),
      correlation_(std::exp(-1.0 / (settings.rate_hz * settings.drift_correlation_time_s))),
      noise_(seed, "barometer/noise"),
      drift_(seed, "barometer/drift") {
  validate(settings, "sensors.barometer");
}

FluidPressure Barometer::read(double height_m, Time now, std::uint64_t index) {
  const double step = settings_.drift_std_pa * drift_.normal(index);
  drift_pa_ = index == 0 ? step : correlation_ * drift_pa_ + std::sqrt(1.0 - correlation_ * correlation_) * step;
  const double warming_k = settings_.warming_k * (1.0 - std::exp(-to_seconds(now) / settings_.warming_time_s));
  const double error_pa =
      offset_pa_ + coefficient_pa_per_k_ * warming_k + drift_pa_ + settings_.noise_std_pa * noise_.normal(index);
  const double step_pa = settings_.resolution_pa;
  double pressure_pa = air_pressure_pa(settings_, height_m) + error_pa;
  if (step_pa > 0.0) pressure_pa = step_pa * std::round(pressure_pa / step_pa);
  return {.stamp = now, .pressure_pa = pressure_pa, .std_pa = settings_.noise_std_pa};
}

namespace {

class BarometerOnBody : public PeriodicSensor {
 public:
  explicit BarometerOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.barometer.rate_hz),
        T_body_imu_(context.robot.T_body("imu")),
        barometer_(context.settings.barometer, context.seed) {}

  void serialize_state(StateArchive& archive) override {
    PeriodicSensor::serialize_state(archive);
    archive(barometer_);
  }

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    readings.emplace_back(barometer_.read((tick.T_world_body * T_body_imu_).position.z(), tick.now, index));
  }

  Pose3 T_body_imu_;
  Barometer barometer_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<FluidPressure>(const SensorContext& context) {
  return context.settings.barometer.enabled ? std::make_unique<BarometerOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
