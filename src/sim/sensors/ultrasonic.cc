#include "sim/sensors/ultrasonic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/sensors/sensor.h"
#include "sim/sensors/surface_optics.h"

namespace patrol::sim {
namespace {

constexpr double kNoEcho = std::numeric_limits<double>::infinity();
constexpr double kBurst_m = 0.065;  // 16 waves of 8 mm, halved for the two-way path
constexpr int kRays = 149;

/// Returns the speed of sound in dry air, m/s.
double speed_of_sound(double temperature_c) { return 331.3 * std::sqrt(1.0 + temperature_c / 273.15); }

std::vector<Pose3> transducers_of(const RobotDescription& robot) {
  std::vector<Pose3> frames = {robot.T_body("ultrasonic_0")};
  for (;;) {
    const auto next = robot.T_body_sensor.find(fmt::format("ultrasonic_{}", frames.size()));
    if (next == robot.T_body_sensor.end()) return frames;
    frames.push_back(next->second);
  }
}

/// Returns directions uniformly distributed over a cone about x, on a golden-angle spiral: no two have equal heights at
/// any rotation.
std::vector<Eigen::Vector3d> cone(double full_angle_rad) {
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double cap = 1.0 - std::cos(0.5 * full_angle_rad);  // height of the spherical cap along x
  std::vector<Eigen::Vector3d> rays;
  for (int i = 0; i < kRays; ++i) {
    const double x = 1.0 - cap * (i + 0.5) / kRays, aside = std::sqrt(1.0 - x * x), angle = i * golden_rad;
    rays.emplace_back(x, aside * std::cos(angle), aside * std::sin(angle));
  }
  return rays;
}

}  // namespace

UltrasonicRing::UltrasonicRing(const UltrasonicSettings& settings, const LidarScene& scene,
                               const RobotDescription& robot, std::uint64_t seed)
    : settings_(settings),
      scene_(scene),
      T_body_transducer_(transducers_of(robot)),
      rays_(cone(settings.fov_deg * kDegree)),
      scale_(speed_of_sound(settings.assumed_temperature_c) / speed_of_sound(settings.air_temperature_c)),
      noise_(seed, "ultrasonic/noise"),
      turn_(seed, "ultrasonic/turn"),
      dropout_(seed, "ultrasonic/dropout"),
      crosstalk_(seed, "ultrasonic/crosstalk") {
  validate(settings, "sensors.ultrasonic");
  const double max_rate_hz = speed_of_sound(settings.air_temperature_c) / (2.0 * settings.range_max_m);
  if (settings.ping_rate_hz > max_rate_hz) {
    throw InputError(
        fmt::format("sensors.ultrasonic.ping_rate_hz = {}: must be at most {:.1f}, so that an echo from "
                    "range_max_m = {} returns before the next ping",
                    settings.ping_rate_hz, max_rate_hz, settings.range_max_m));
  }
  const mjModel& model = scene.model();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    is_rough_.push_back(model.geom_type[geom] == mjGEOM_HFIELD || is_named_after(model, geom, settings.rough_names));
  }
}

/// Returns the echo strength of a ray with this cosine of incidence on a geom.
double UltrasonicRing::strength(int geom, double cosine) const {
  if (is_rough_[static_cast<std::size_t>(geom)]) return settings_.rough_echo_ratio * cosine;
  return cosine >= std::cos(settings_.specular_cutoff_deg * kDegree) ? 1.0 : 0.0;
}

UltrasonicRing::Echo UltrasonicRing::trace_ping(const Pose3& T_world_transducer, double turn_rad) const {
  struct Part {
    RayHit hit;
    double strength;
    Eigen::Vector3d direction;
  };
  const Eigen::Matrix3d R =
      (T_world_transducer.rotation * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitX())).toRotationMatrix();
  std::vector<Part> parts;
  for (const Eigen::Vector3d& ray : rays_) {
    const Eigen::Vector3d direction = R * ray;
    const auto hit = scene_.cast(T_world_transducer.position, direction, settings_.range_max_m, kRayScenery);
    if (!hit) continue;
    const double returned = strength(hit->geom, std::abs(hit->normal.dot(direction)));
    if (returned > 0.0) parts.push_back({*hit, returned, direction});
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.hit.distance_m < b.hit.distance_m; });

  double sum = 0.0;  // echo strength within one pulse length
  for (std::size_t first = 0, last = 0; last < parts.size(); ++last) {
    const RayHit& hit = parts[last].hit;
    sum += parts[last].strength;
    for (; parts[first].hit.distance_m < hit.distance_m - kBurst_m; ++first) sum -= parts[first].strength;
    if (sum < settings_.detection_threshold * kRays) continue;
    return {.distance_m = hit.distance_m,
            .p_world = T_world_transducer.position + hit.distance_m * parts[last].direction,
            .normal = hit.normal,
            .geom = hit.geom};
  }
  return {.distance_m = kNoEcho};
}

/// Returns the range at which a transducer reports the echo of another's ping: half the path length. +Inf beyond twice
/// the cone, or when the surface reflects the sound elsewhere.
double UltrasonicRing::crosstalk_range_m(const Echo& echo, const Pose3& T_world_other,
                                         const Pose3& T_world_transducer) const {
  if (!std::isfinite(echo.distance_m)) return kNoEcho;
  const Eigen::Vector3d offset = T_world_transducer.position - echo.p_world;
  const Eigen::Vector3d axis = T_world_transducer.rotation * Eigen::Vector3d::UnitX();
  const double off_axis = std::acos(std::clamp(-offset.normalized().dot(axis), -1.0, 1.0));
  if (off_axis > settings_.fov_deg * kDegree) return kNoEcho;
  const Eigen::Vector3d middle =
      (offset.normalized() + (T_world_other.position - echo.p_world).normalized()).normalized();
  if (strength(echo.geom, std::abs(middle.dot(echo.normal))) <= 0.0) return kNoEcho;
  return 0.5 * (echo.distance_m + offset.norm());
}

float UltrasonicRing::reading(double distance_m, std::uint64_t tick, std::uint64_t transducer) const {
  if (dropout_.uniform(tick, transducer) < settings_.dropout_probability) return std::numeric_limits<float>::infinity();
  double range_m = scale_ * distance_m;
  if (range_m < settings_.range_min_m) return -std::numeric_limits<float>::infinity();
  range_m += settings_.range_noise_std_m * noise_.normal(tick, transducer);
  if (settings_.range_quantization_m > 0.0)
    range_m = settings_.range_quantization_m * std::round(range_m / settings_.range_quantization_m);
  return range_m > settings_.range_max_m ? std::numeric_limits<float>::infinity() : static_cast<float>(range_m);
}

std::vector<UltrasonicRange> UltrasonicRing::ping(const Pose3& T_world_body, Time now, std::uint64_t tick) const {
  const std::size_t group = std::min(num_transducers(), static_cast<std::size_t>(settings_.group_size));
  const std::size_t slots = (num_transducers() + group - 1) / group;
  std::vector<std::size_t> fired;
  std::vector<Pose3> frames;
  std::vector<Echo> echoes;
  for (std::size_t i = tick % slots; i < num_transducers(); i += slots) {
    fired.push_back(i);
    frames.push_back(T_world_body * T_body_transducer_[i]);
    echoes.push_back(trace_ping(frames.back(), 2.0 * std::numbers::pi * turn_.uniform(tick, i)));
  }
  std::vector<UltrasonicRange> ranges;
  for (std::size_t receiver = 0; receiver < fired.size(); ++receiver) {
    double distance_m = echoes[receiver].distance_m;
    for (std::size_t other = 0; other < fired.size(); ++other) {
      if (other == receiver) continue;
      if (crosstalk_.uniform(tick, fired[receiver] * num_transducers() + fired[other]) >=
          settings_.crosstalk_probability)
        continue;
      distance_m = std::min(distance_m, crosstalk_range_m(echoes[other], frames[other], frames[receiver]));
    }
    ranges.push_back({.stamp = now,
                      .transducer = static_cast<int>(fired[receiver]),
                      .field_of_view_rad = settings_.fov_deg * kDegree,
                      .range_min_m = settings_.range_min_m,
                      .range_max_m = settings_.range_max_m,
                      .range_m = reading(distance_m, tick, fired[receiver])});
  }
  return ranges;
}

namespace {

class UltrasonicOnBody : public PeriodicSensor {
 public:
  explicit UltrasonicOnBody(const SensorContext& context)
      : PeriodicSensor(context.settings.ultrasonic.ping_rate_hz),
        ring_(context.settings.ultrasonic, context.scene, context.robot, context.seed) {}

 private:
  void read(const SensorTick& tick, std::uint64_t index, std::vector<SensorMessage>& readings) override {
    for (const UltrasonicRange& range : ring_.ping(tick.T_world_body, tick.now, index)) readings.emplace_back(range);
  }

  UltrasonicRing ring_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<UltrasonicRange>(const SensorContext& context) {
  return context.settings.ultrasonic.enabled ? std::make_unique<UltrasonicOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
