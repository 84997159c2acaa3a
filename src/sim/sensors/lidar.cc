#include "sim/sensors/lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::sim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns separated by more than the length of a 10 ns pulse are distinct; below kMinJump_m they are one surface.
constexpr double kPulseLength_m = 1.5;
constexpr double kMinJump_m = 0.1;

/// Interpolates like `interpolate`. For poses as close as those of two ticks it uses the chord instead of the arc
/// (error below 1e-7 rad).
Pose3 move_between(const Pose3& a, const Pose3& b, double fraction) {
  const double cosine = a.rotation.dot(b.rotation);
  if (cosine < 0.9999) return interpolate(a, b, fraction);
  const Eigen::Vector4d chord = (1.0 - fraction) * a.rotation.coeffs() + fraction * b.rotation.coeffs();
  return {a.position + fraction * (b.position - a.position), Eigen::Quaterniond(chord.normalized())};
}

}  // namespace

Lidar::Lidar(const LidarSettings& settings, const LidarScene& scene, Pose3 T_body_lidar, RayMask own_housing,
             std::uint64_t seed, const std::string& name, const DustSettings& dust, const LidarErrors& errors,
             BackgroundWorker* worker)
    : settings_(settings),
      scene_(scene),
      T_body_lidar_(std::move(T_body_lidar)),
      mask_(kRayEverything & ~static_cast<std::uint32_t>(own_housing)),
      dust_(dust),
      errors_(errors),
      aim_(errors),
      min_incidence_cosine_(std::cos(settings.max_incidence_deg * kDegree)),
      surfaces_(surface_optics(scene.model())),
      false_return_rate_per_m_(settings.false_return_rate_per_m +
                               dust.backscatter_probability * dust.extinction_per_m()),
      range_noise_(seed, name + "/range"),
      is_wide_(seed, name + "/is_wide"),
      wide_noise_(seed, name + "/wide"),
      angle_noise_(seed, name + "/angle"),
      dropout_(seed, name + "/dropout"),
      rain_(seed, name + "/rain"),
      rain_range_(seed, name + "/rain_range"),
      rate_noise_(seed, name + "/rate"),
      revolution_ns_(1e9 / settings.rate_hz),
      worker_(worker) {
  validate(settings, name);
  settings_.range_noise_std_m *= errors.noise_ratio;
  const double step = settings.fov_deg * kDegree / settings.beams, used = settings.fov_deg / 360.0;
  for (int beam = 0; beam < settings.beams; ++beam) {
    const double angle = -settings.fov_deg * kDegree / 2.0 + beam * step;
    azimuth_.emplace_back(std::cos(angle), std::sin(angle));
    instants_.push_back(1.0 - used + used * static_cast<double>(beam + 1) / settings.beams);
  }
  for (int ring = 0; ring < settings.rings; ++ring) {
    const double fraction = settings.rings > 1 ? static_cast<double>(ring) / (settings.rings - 1) : 0.0;
    const double angle =
        kDegree * (settings.elevation_min_deg + fraction * (settings.elevation_max_deg - settings.elevation_min_deg));
    elevation_.emplace_back(std::cos(angle), std::sin(angle));
  }
  begin_revolution();
}

Lidar::~Lidar() {
  if (!worker_) return;
  try {
    worker_->wait(submitted_);
  } catch (...) {  // the run ends with the error that the owner has seen
  }
}

/// The beams are distributed over the fraction of the revolution that the field of view covers; the last one ends it.
Time Lidar::instant_of(std::int64_t beam) const {
  const std::int64_t revolution = beam / settings_.beams, index = beam % settings_.beams;
  const double revolution_ns = 1e9 / settings_.rate_hz;
  const double in_revolution = instants_[static_cast<std::size_t>(index)];
  if (errors_.rate_std > 0.0) return Time{std::llround(revolution_begin_ns_ + in_revolution * revolution_ns_)};
  return Time{std::llround((static_cast<double>(revolution) + in_revolution) * revolution_ns)};
}

/// Advances the revolution rate, a Gauss-Markov process, to the revolution of the next beam.
void Lidar::update_rate() {
  constexpr double kCorrelationTime_s = 5.0;
  const double correlation = std::exp(-1.0 / (settings_.rate_hz * kCorrelationTime_s));
  const auto revolution = static_cast<std::uint64_t>(next_beam_ / settings_.beams);
  const double draw = errors_.rate_std * rate_noise_.normal(revolution);
  if (revolution > 0) revolution_begin_ns_ += revolution_ns_;
  rate_error_ = revolution == 0 ? draw : correlation * rate_error_ + std::sqrt(1.0 - correlation * correlation) * draw;
  revolution_ns_ = 1e9 / (settings_.rate_hz * (1.0 + rate_error_));
}

void Lidar::begin_revolution() {
  if (errors_.rate_std > 0.0) update_rate();
  revolution_ = std::make_shared<Revolution>();
  revolution_->last_range_m.assign(elevation_.size(), kInfinity);
  if (has_rings()) {
    revolution_->cloud.stamp = instant_of(next_beam_);
    return;
  }
  const double step = settings_.fov_deg * kDegree / settings_.beams;
  LaserScan& scan = revolution_->scan;
  scan = {.stamp = instant_of(next_beam_),
          .angle_min_rad = -settings_.fov_deg * kDegree / 2.0,
          .angle_increment_rad = step,
          .time_increment_s = settings_.fov_deg / 360.0 / settings_.rate_hz / settings_.beams,
          .scan_time_s = 1.0 / settings_.rate_hz,
          .range_min_m = settings_.range_min_m,
          .range_max_m = settings_.range_max_m,
          .ranges_m = {},
          .intensities = {}};
  scan.ranges_m.reserve(static_cast<std::size_t>(settings_.beams));
  scan.intensities.reserve(static_cast<std::size_t>(settings_.beams));
}

void Lidar::advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to) {
  constexpr std::size_t kTicksPerTask = 8;
  Shots* shots = nullptr;
  for (Time instant = instant_of(next_beam_); instant <= to; instant = instant_of(next_beam_)) {
    const double fraction = to_seconds(instant - from) / to_seconds(to - from);
    Pose3 T_world_lidar = move_between(T_world_body_from, T_world_body_to, fraction) * T_body_lidar_;
    if (settings_.stabilized) T_world_lidar = remove_tilt(T_world_lidar);
    const bool is_last = next_beam_ % settings_.beams == settings_.beams - 1;
    if (!shots) {
      shots = &shots_.emplace_back(Shots{.bodies = scene_.poses(), .beams = {}});
      if (settings_.motion_distortion) shots->beams.reserve(max_beams_);
    }
    if (settings_.motion_distortion) {
      shots->beams.push_back({next_beam_, instant, T_world_lidar});
    } else if (is_last) {
      for (std::int64_t beam = next_beam_ - settings_.beams + 1; beam <= next_beam_; ++beam)
        shots->beams.push_back({beam, instant_of(beam), T_world_lidar});
    }
    ++next_beam_;
    max_beams_ = std::max(max_beams_, shots->beams.size());
    if (!is_last) continue;
    finish_revolution();
    begin_revolution();
    shots = nullptr;
  }
  if (shots_.size() >= kTicksPerTask) submit();
}

/// Measures the beams, or gives them to the worker.
void Lidar::submit() {
  auto measure_beams = [this, shots = std::exchange(shots_, {}), revolution = revolution_] {
    for (const Shots& of_tick : shots) fire(of_tick, *revolution);
  };
  if (worker_) submitted_ = worker_->submit(std::move(measure_beams));
  else measure_beams();
}

void Lidar::finish_revolution() {
  submit();
  LaserScan& scan = revolution_->scan;
  if (!has_rings() && !settings_.motion_distortion) {
    scan.stamp = instant_of(next_beam_ - 1);
    scan.time_increment_s = 0.0;
  }
  fired_.push_back({.ticket = submitted_, .revolution = revolution_});
}

Lidar::Revolution& Lidar::measured(const FiredRevolution& fired) const {
  if (worker_) worker_->wait(fired.ticket);
  return *fired.revolution;
}

std::vector<LaserScan> Lidar::take_scans() {
  std::vector<LaserScan> scans;
  if (has_rings()) return scans;
  for (const FiredRevolution& fired : take_fired()) scans.push_back(std::move(measured(fired).scan));
  return scans;
}

std::vector<PointCloud> Lidar::take_clouds() {
  std::vector<PointCloud> clouds;
  if (!has_rings()) return clouds;
  for (const FiredRevolution& fired : take_fired()) clouds.push_back(std::move(measured(fired).cloud));
  return clouds;
}

Eigen::Vector3d Lidar::direction(std::size_t column, std::size_t ring) const {
  return {elevation_[ring].x() * azimuth_[column].x(), elevation_[ring].x() * azimuth_[column].y(),
          elevation_[ring].y()};
}

void Lidar::fire(const Shots& shots, Revolution& revolution) const {
  constexpr std::size_t kBeamsPerCone = 32;
  std::vector<Eigen::Vector3d> aims;  // in lidar
  std::vector<Ray> rays;
  std::vector<std::optional<RayHit>> hits;
  for (std::size_t begin = 0; begin < shots.beams.size(); begin += kBeamsPerCone) {
    const std::span beams = std::span(shots.beams).subspan(begin, std::min(kBeamsPerCone, shots.beams.size() - begin));
    const LidarScene::Targets targets = scene_.targets(shots.bodies, cone_of(beams), settings_.range_max_m, mask_);
    aims.clear(), rays.clear();
    for (const Beam& beam : beams) {
      for (std::size_t ring = 0; ring < elevation_.size(); ++ring) {
        aims.push_back(aimed(beam, ring));
        rays.push_back({beam.T_world_lidar.position, beam.T_world_lidar.rotation * aims.back()});
      }
    }
    hits.resize(rays.size());
    scene_.cast(targets, rays, hits);
    std::size_t i = 0;
    for (const Beam& beam : beams) {
      for (std::size_t ring = 0; ring < elevation_.size(); ++ring, ++i) {
        const Return ideal = to_return(hits[i], rays[i].direction);
        record(beam, ring, measure(beam, ring, targets, aims[i], ideal, revolution.last_range_m[ring]), revolution);
      }
    }
  }
}

/// Returns a cone about the beams. Errors of direction beyond its margin cost time only.
RayCone Lidar::cone_of(std::span<const Beam> beams) const {
  const double margin_rad = kDegree * (0.5 + 0.5 * settings_.beam_width_deg + 4.0 * settings_.angle_noise_std_deg);
  const Beam& middle = beams[beams.size() / 2];
  RayCone cone{.center = middle.T_world_lidar.position, .radius_m = 0.0, .axis = Eigen::Vector3d::Zero()};
  for (const std::size_t ring : {std::size_t{0}, elevation_.size() - 1})
    cone.axis += middle.T_world_lidar.rotation * direction(column_of(middle), ring);
  cone.axis.normalize();
  for (const Beam* end : {&beams.front(), &beams.back()}) {
    cone.radius_m = std::max(cone.radius_m, (end->T_world_lidar.position - cone.center).norm() + 1e-6);
    for (const std::size_t ring : {std::size_t{0}, elevation_.size() - 1}) {
      const Eigen::Vector3d ray = end->T_world_lidar.rotation * direction(column_of(*end), ring);
      cone.cosine = std::min(cone.cosine, cone.axis.dot(ray));
    }
  }
  const double half_angle_rad = std::min(std::acos(cone.cosine) + margin_rad, std::numbers::pi / 2.0);
  cone.cosine = std::cos(half_angle_rad);
  cone.sine = std::sin(half_angle_rad);
  return cone;
}

/// Appends a reading to its revolution.
void Lidar::record(const Beam& beam, std::size_t ring, const Return& got, Revolution& revolution) const {
  if (settings_.rings == 1) {
    revolution.scan.ranges_m.push_back(static_cast<float>(got.range_m));
    revolution.scan.intensities.push_back(static_cast<float>(got.intensity));
  } else if (std::isfinite(got.range_m)) {
    const Eigen::Vector3f point = (got.range_m * direction(column_of(beam), ring)).cast<float>();
    revolution.cloud.points.push_back({.x = point.x(),
                                       .y = point.y(),
                                       .z = point.z(),
                                       .intensity = static_cast<float>(got.intensity),
                                       .time_s = static_cast<float>(to_seconds(beam.instant - revolution.cloud.stamp)),
                                       .ring = static_cast<std::uint16_t>(ring)});
  }
}

/// Returns the actual direction of a beam, in lidar.
Eigen::Vector3d Lidar::aimed(const Beam& beam, std::size_t ring) const {
  const std::size_t column = column_of(beam);
  Eigen::Vector3d aimed = direction(column, ring);
  if (settings_.angle_noise_std_deg > 0.0) {
    const double turn =
        settings_.angle_noise_std_deg * kDegree * angle_noise_.normal(tick_of(beam), column * elevation_.size() + ring);
    aimed += turn * Eigen::Vector3d(-aimed.y(), aimed.x(), 0.0);
    aimed.normalize();
  }
  return aim_(aimed);
}

/// Returns the reading of one beam with all error sources, given that of the ideal ray along its axis.
Lidar::Return Lidar::measure(const Beam& beam, std::size_t ring, const LidarScene::Targets& targets,
                             const Eigen::Vector3d& aimed, const Return& ideal, double& last_range_m) const {
  const std::uint64_t tick = tick_of(beam), index = column_of(beam) * elevation_.size() + ring;
  Return got = ideal;
  const double jump_m = std::abs(got.range_m - std::exchange(last_range_m, got.range_m));
  if (jump_m > kMinJump_m && jump_m < kPulseLength_m && settings_.beam_width_deg > 0.0) {
    got = mixed_pixel_return(targets, beam.T_world_lidar, aimed, got);
  }
  if (false_return_rate_per_m_ > 0.0) {
    const double path_m = std::min(got.range_m, settings_.range_max_m);
    if (rain_.uniform(tick, index) < 1.0 - std::exp(-false_return_rate_per_m_ * path_m)) {
      got = {path_m * rain_range_.uniform(tick, index), 5.0};
    }
  }
  if (settings_.dropout_probability > 0.0 && dropout_.uniform(tick, index) < settings_.dropout_probability)
    return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (!std::isfinite(got.range_m)) return got;
  if (got.range_m < settings_.range_min_m) return {-kInfinity, got.intensity};
  got.range_m += settings_.range_noise_std_m * range_noise_.normal(tick, index);
  if (settings_.wide_noise_probability > 0.0 && is_wide_.uniform(tick, index) < settings_.wide_noise_probability)
    got.range_m += settings_.wide_noise_std_m * wide_noise_.normal(tick, index);
  if (settings_.range_quantization_m > 0.0) {
    got.range_m = settings_.range_quantization_m * std::round(got.range_m / settings_.range_quantization_m);
  }
  if (got.range_m > settings_.range_max_m) return {kInfinity, 0.0};
  return got;
}

/// Returns the mean over the beam width, weighted by the returned light, of surfaces within one pulse length only.
Lidar::Return Lidar::mixed_pixel_return(const LidarScene::Targets& targets, const Pose3& T_world_lidar,
                                        const Eigen::Vector3d& direction, const Return& middle) const {
  constexpr std::size_t kRays = 4;
  const Eigen::Vector3d sideways =
      settings_.beam_width_deg * kDegree * Eigen::Vector3d(-direction.y(), direction.x(), 0.0);
  std::array<Ray, kRays> rays;
  for (std::size_t i = 0; i < kRays; ++i) {
    const double fraction = (static_cast<double>(i) + 0.5) / kRays - 0.5;
    rays[i] = {T_world_lidar.position, T_world_lidar.rotation * (direction + fraction * sideways).normalized()};
  }
  std::array<std::optional<RayHit>, kRays> hits;
  scene_.cast(targets, rays, hits);
  double light = 0.0, light_range = 0.0, light_intensity = 0.0;
  for (std::size_t i = 0; i < kRays; ++i) {
    const Return part = to_return(hits[i], rays[i].direction);
    if (!(std::abs(part.range_m - middle.range_m) < kPulseLength_m)) continue;
    const double returned = part.intensity / (part.range_m * part.range_m);
    light += returned;
    light_range += returned * part.range_m;
    light_intensity += returned * part.intensity;
  }
  return light > 0.0 ? Return{light_range / light, light_intensity / light} : middle;
}

/// Returns the reading of an ideal ray without width. Glass off its normal, grazing incidence, and dark distant
/// surfaces return nothing.
Lidar::Return Lidar::to_return(const std::optional<RayHit>& hit, const Eigen::Vector3d& direction) const {
  if (!hit) return {kInfinity, 0.0};
  const double range_m = hit->distance_m, cosine = std::abs(hit->normal.dot(direction));
  const SurfaceOptics& surface = surfaces_[static_cast<std::size_t>(hit->geom)];
  if (surface.is_transparent_at(cosine)) return {kInfinity, 0.0};
  if (cosine < min_incidence_cosine_) return {kInfinity, 0.0};
  // The returned light falls with the square of the range. range_max_m is reached on white, max_range_10pct_m on 10 %.
  const double reflectivity = std::max(0.02, static_cast<double>(surface.reflectivity));
  const double reach_m =
      std::min(settings_.range_max_m, settings_.max_range_10pct_m * std::sqrt(reflectivity * std::sqrt(cosine) / 0.1));
  if (settings_.max_range_10pct_m > 0.0 && dust_.equivalent_clear_distance_m(range_m) > reach_m)
    return {kInfinity, 0.0};
  return {range_m + errors_.range_error_m(range_m, reflectivity, cosine), 255.0 * std::min(1.0, reflectivity * cosine)};
}

}  // namespace patrol::sim
