#include "sim/sensors/tdlas.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sensors/sensor.h"

namespace patrol::sim {

Tdlas::Tdlas(const TdlasSettings& settings, std::uint64_t seed)
    : settings_(settings), noise_(seed, "tdlas/noise"), relative_noise_(seed, "tdlas/relative_noise") {
  validate(settings, "sensors.tdlas");
}

GasReading Tdlas::read(const LidarScene& scene, const GasPlume& plume, const Pose3& T_world_tdlas, Time now,
                       std::uint64_t tick) const {
  const Eigen::Vector3d direction = T_world_tdlas.rotation * Eigen::Vector3d::UnitX();
  const std::optional<RayHit> hit = scene.cast(T_world_tdlas.position, direction, settings_.range_m, kRayScenery);
  GasReading reading{.stamp = now};
  if (!hit) {  // no backscattered light: no reading
    reading.path_length_m = std::numeric_limits<double>::infinity();
    return reading;
  }
  const double length_m = hit->distance_m;
  double column = settings_.background_ppm * length_m;
  if (!plume.is_empty()) column += plume.column_ppm_m(T_world_tdlas.position, direction, length_m, to_seconds(now));
  column += settings_.noise_std_ppm_m * noise_.normal(tick) +
            settings_.relative_noise_std * column * relative_noise_.normal(tick);
  if (settings_.resolution_ppm_m > 0.0)
    column = settings_.resolution_ppm_m * std::round(column / settings_.resolution_ppm_m);
  reading.column_ppm_m = std::clamp(column, 0.0, settings_.max_column_ppm_m);
  reading.path_length_m = length_m;
  // ppm x kg/m3 = mg/m3
  reading.mean_mg_m3 = reading.column_ppm_m / std::max(length_m, 0.1) * kMethaneDensity_kgpm3;
  return reading;
}

namespace {

class TdlasOnBody : public PeriodicSensor {
 public:
  explicit TdlasOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.tdlas.rate_hz),
        scene_(context.scene),
        plume_(context.plume),
        T_body_tdlas_(context.robot.T_body("tdlas")),
        tdlas_(context.settings.tdlas, context.seed) {}

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    readings.emplace_back(tdlas_.read(scene_, plume_, tick.T_world_body * T_body_tdlas_, tick.now, index));
  }

  const LidarScene& scene_;
  GasPlume plume_;
  Pose3 T_body_tdlas_;
  Tdlas tdlas_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<GasReading>(const SensorContext& context) {
  return context.settings.tdlas.enabled ? std::make_unique<TdlasOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
