#include "sim/sensors/gnss.h"

#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"
#include "core/site/geodetic_datum.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
Gnss::Gnss(const GnssSettings& settings, std::uint64_t seed) : settings_(settings), noise_(seed, "gnss/noise") {
  validate(settings, "sensors.gnss");
}

/// Returns the visible fraction of the sky: free rays to 24 directions, 15 to 75 degrees above the horizon.
double Gnss::open_sky_fraction(const LidarScene& scene, const Eigen::Vector3d& antenna) {
  constexpr int kAzimuths = 8;
  int open = 0, all = 0;
  for (const double elevation : {15.0 * kDegree, 45.0 * kDegree, 75.0 * kDegree}) {
    for (int i = 0; i < kAzimuths; ++i, ++all) {
      const double azimuth = 2.0 * std::numbers::pi * i / kAzimuths + elevation;
      const Eigen::Vector3d direction(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                      std::sin(elevation));
      if (!scene.cast(antenna, direction, 100.0, kRayScenery)) ++open;
    }
  }
  return static_cast<double>(open) / all;
}

GnssFix Gnss::read(const LidarScene& scene, const Eigen::Vector3d& p_world_antenna, Time now, std::uint64_t tick) {
  const double sky = open_sky_fraction(scene, p_world_antenna);
  const bool is_open = sky >= settings_.min_open_sky_fix;
  if (is_open && !was_open_) open_since_ = now + from_seconds(settings_.fix_reacquisition_time_s);
  was_open_ = is_open;

  GnssFix fix{.stamp = now};
  fix.status = is_open && now >= open_since_         ? GnssStatus::kFix
               : sky >= settings_.min_open_sky_float ? GnssStatus::kFloat
                                                     : GnssStatus::kNone;
  // Use a Gauss-Markov error, so that averaging helps no more than with a real receiver.
  const double correlation = std::exp(-1.0 / (settings_.rate_hz * settings_.error_correlation_time_s));
  for (int axis = 0; axis < 3; ++axis) {
    error_[axis] = tick == 0 ? noise_.normal(0, static_cast<std::uint64_t>(axis))
                             : correlation * error_[axis] + std::sqrt(1.0 - correlation * correlation) *
                                                                noise_.normal(tick, static_cast<std::uint64_t>(axis));
  }
  if (fix.status == GnssStatus::kNone) return fix;
  const double std_m = fix.status == GnssStatus::kFix ? settings_.fix_noise_std_m : settings_.float_noise_std_m;
  fix.position_std_m = Eigen::Vector3d(std_m, std_m, 2.0 * std_m);
  const Eigen::Vector3d enu = p_world_antenna + fix.position_std_m.cwiseProduct(error_);
  const GeodeticPosition position = to_geodetic(
      {.latitude_deg = settings_.datum_latitude_deg, .longitude_deg = settings_.datum_longitude_deg}, enu.head<2>());
  fix.latitude_deg = position.latitude_deg;
  fix.longitude_deg = position.longitude_deg;
  fix.altitude_m = enu.z();
  return fix;
}

namespace {

class GnssOnBody : public PeriodicSensor {
 public:
  explicit GnssOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.gnss.rate_hz),
        scene_(context.scene),
        T_body_gnss_(context.robot.T_body("gnss")),
        gnss_(context.settings.gnss, context.seed) {}

  void serialize_state(StateArchive& archive) override {
    PeriodicSensor::serialize_state(archive);
    archive(gnss_);
  }

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    readings.emplace_back(gnss_.read(scene_, tick.T_world_body * T_body_gnss_.position, tick.now, index));
  }

  const LidarScene& scene_;
  Pose3 T_body_gnss_;
  Gnss gnss_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<GnssFix>(const SensorContext& context) {
  return context.settings.gnss.enabled ? std::make_unique<GnssOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
