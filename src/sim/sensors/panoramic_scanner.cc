#include "sim/sensors/panoramic_scanner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

constexpr double kNoReturn = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kMask = kRayEverything & ~static_cast<std::uint32_t>(kRayScanner);

/// Returns the range curvature above which neighboring beams are at an edge.
double min_edge_curvature_m(double range_m) { return std::max(0.01, 0.003 * range_m); }

/// Returns the deviation of the middle of three ranges from the mean of the others; 0 if one of them has no return.
double range_curvature_m(double before_m, double range_m, double after_m) {
  const double bend = std::abs(range_m - 0.5 * (before_m + after_m));
  return std::isfinite(bend) ? bend : 0.0;
}

/// Returns the random stream of one error source in one epoch: "scanner/range" for inspections,
/// "scanner/reference/range" for references.
RandomStream stream_of(const PanoramicScannerSettings& settings, std::uint64_t seed, std::string_view imperfection) {
  const std::string_view epoch = settings.epoch == "reference" ? "reference/" : "";
  return {seed, fmt::format("scanner/{}{}", epoch, imperfection)};
}

}  // namespace

PanoramicScanner::PanoramicScanner(const PanoramicScannerSettings& settings, const LidarScene& scene,
                                   Pose3 T_body_scanner, std::uint64_t seed, const DustSettings& dust,
                                   const ScannerErrors& errors)
    : settings_(settings),
      scene_(scene),
      T_body_scanner_(std::move(T_body_scanner)),
      dust_(dust),
      errors_(errors),
      surfaces_(surface_optics(scene.model())),
      range_noise_(stream_of(settings, seed, "range")),
      range_offset_(stream_of(settings, seed, "range_offset")),
      angle_noise_(stream_of(settings, seed, "angle")),
      tilt_error_(stream_of(settings, seed, "tilt")),
      dropout_(stream_of(settings, seed, "dropout")) {
  validate(settings, "sensors.scanner");
  const auto pairs = static_cast<int>(std::lround(180.0 / settings.step_deg));
  for (int pair = 0; pair < pairs; ++pair) {
    const double angle = -std::numbers::pi / 2.0 + std::numbers::pi * pair / pairs;
    azimuth_.emplace_back(std::cos(angle), std::sin(angle));
  }
  const auto rows = static_cast<int>(std::floor((90.0 - settings.elevation_min_deg) / settings.step_deg + 1e-9)) + 1;
  for (int row = 0; row < rows; ++row) {
    const double angle = kDegree * (settings.elevation_min_deg + row * settings.step_deg);
    elevation_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

void PanoramicScanner::begin(Time now, const Pose3& T_world_body) {
  if (scan_) return;
  const std::uint64_t number = num_begun_++;
  const Eigen::Quaterniond R_world_scanner = T_world_body.rotation * T_body_scanner_.rotation;
  const auto tilt = tilt_error_.normals(number);
  const double std_rad = settings_.tilt_error_std_deg * kDegree;
  scan_ =
      Scan{.start = now,
           .number = number,
           .R_level_scanner = quaternion_from_rpy(std_rad * tilt[0], std_rad * tilt[1], 0.0) *
                              quaternion_from_yaw(-to_yaw(R_world_scanner)) * R_world_scanner,
           .range_offset_m = errors_.range_offset_ratio * settings_.range_offset_std_m * range_offset_.normal(number),
           .before_m = {},
           .points = {}};
  const std::vector<double> no_returns(elevation_.size(), kNoReturn);
  scan_->before_m = {{{no_returns, no_returns}, {no_returns, no_returns}}};
  scan_->points.reserve(2 * azimuth_.size() * elevation_.size());
}

/// The last pair ends the scan.
Time PanoramicScanner::instant_of(int pair) const {
  return scan_->start + from_seconds(settings_.duration_s * (pair + 1) / static_cast<double>(azimuth_.size()));
}

void PanoramicScanner::advance(Time from, Time to, const Pose3& T_world_body_from, const Pose3& T_world_body_to) {
  while (scan_ && instant_of(scan_->next_pair) <= to) {
    const Time instant = instant_of(scan_->next_pair);
    const double fraction = to_seconds(instant - from) / to_seconds(to - from);
    const Pose3 T_world_scanner = interpolate(T_world_body_from, T_world_body_to, fraction) * T_body_scanner_;
    const int pairs = static_cast<int>(azimuth_.size());
    for (const int column : {scan_->next_pair, scan_->next_pair + pairs}) fire_column(column, T_world_scanner);
    if (++scan_->next_pair < pairs) continue;
    scans_.push_back({.stamp = instant, .points = std::move(scan_->points)});
    scan_.reset();
  }
}

PanoramicScanner::Beam PanoramicScanner::beam_at(int column, std::size_t row) const {
  const auto pair = static_cast<std::size_t>(column) % azimuth_.size();
  const bool is_front = static_cast<std::size_t>(column) == pair;
  const Eigen::Vector2d ahead = is_front ? azimuth_[pair] : Eigen::Vector2d(-azimuth_[pair]);
  const double c = elevation_[row].x(), s = elevation_[row].y();
  return {.nominal = {c * ahead.x(), c * ahead.y(), s},
          .left = {-ahead.y(), ahead.x(), 0.0},
          .up = {-s * ahead.x(), -s * ahead.y(), c},
          .cosine = c,
          .deviation =
              errors_.deviation(std::atan2(azimuth_[pair].y(), azimuth_[pair].x()), std::atan2(s, c), is_front)};
}

Eigen::Vector3d PanoramicScanner::Beam::aimed(double azimuth_error_rad, double elevation_error_rad) const {
  const Eigen::Vector3d aside = cosine * left;
  return (nominal + azimuth_error_rad * aside + elevation_error_rad * up + deviation.left_rad * left +
          deviation.up_rad * up)
      .normalized();
}

/// Returns the pose of the scanner moved to the origin of a beam, which does not pass exactly through the center.
Pose3 PanoramicScanner::beam_origin(const Pose3& T_world_scanner, const Beam& beam) const {
  return {T_world_scanner * (beam.deviation.left_m * beam.left + beam.deviation.up_m * beam.up),
          T_world_scanner.rotation};
}

/// Fires every beam of the column along its axis, averages beams at edges over their width, and adds the instrument
/// errors.
void PanoramicScanner::fire_column(int column, const Pose3& T_world_scanner) {
  const std::size_t rows = elevation_.size();
  const auto index = [&](std::size_t row) { return static_cast<std::uint64_t>(column) * rows + row; };
  std::vector<Beam> beams(rows);
  std::vector<Eigen::Vector3d> aimed(rows);
  std::vector<Return> ideal(rows);
  const double angle_std_rad = errors_.angle_noise_ratio * settings_.angle_noise_std_deg * kDegree;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto error = angle_noise_.normals(scan_->number, index(row));
    beams[row] = beam_at(column, row);
    aimed[row] = beams[row].aimed(angle_std_rad * error[0], angle_std_rad * error[1]);
    ideal[row] = trace(beam_origin(T_world_scanner, beams[row]), aimed[row]);
  }
  auto& [one_ago, two_ago] = scan_->before_m[static_cast<std::size_t>(column) < azimuth_.size() ? 0 : 1];
  for (std::size_t row = 0; row < rows; ++row) {
    const double range_m = ideal[row].range_m;
    const double upwards =
        row == 0 || row + 1 == rows ? 0.0 : range_curvature_m(ideal[row - 1].range_m, range_m, ideal[row + 1].range_m);
    const double sideways = 2.0 * range_curvature_m(range_m, one_ago[row], two_ago[row]);
    two_ago[row] = std::exchange(one_ago[row], range_m);
    const bool is_at_edge =
        settings_.beam_divergence_rad > 0.0 && std::max(upwards, sideways) > min_edge_curvature_m(range_m);
    report(beams[row].nominal.normalized(),
           is_at_edge ? mixed_pixel_return(beam_origin(T_world_scanner, beams[row]), aimed[row], range_m) : ideal[row],
           index(row));
  }
}

/// Appends the point of beam number `index` unless its return is lost.
void PanoramicScanner::report(const Eigen::Vector3d& direction, const Return& beam_return, std::uint64_t index) {
  if (beam_return.range_m > settings_.range_max_m || beam_return.range_m < settings_.range_min_m) return;
  if (settings_.dropout_probability > 0.0 && dropout_.uniform(scan_->number, index) < settings_.dropout_probability)
    return;
  const double measured_m = beam_return.range_m + scan_->range_offset_m + errors_.range_error_m(beam_return.range_m) +
                            range_std_m(beam_return) * range_noise_.normal(scan_->number, index);
  const Eigen::Vector3f point = (scan_->R_level_scanner * (measured_m * direction)).cast<float>();
  scan_->points.push_back({.x = point.x(),
                           .y = point.y(),
                           .z = point.z(),
                           .intensity = static_cast<float>(255.0 * std::min(1.0, beam_return.light))});
}

/// Returns the reading of an ideal ray without width. Glass, grazing incidence, and dark distant surfaces return
/// nothing.
PanoramicScanner::Return PanoramicScanner::trace(const Pose3& T_world_scanner, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d ray = T_world_scanner.rotation * direction;
  const std::optional<RayHit> hit = scene_.cast(T_world_scanner.position, ray, settings_.range_max_m, kMask);
  if (!hit) return {kNoReturn, 0.0};
  const double cosine = std::abs(hit->normal.dot(ray));
  const SurfaceOptics& surface = surfaces_[static_cast<std::size_t>(hit->geom)];
  if (surface.is_transparent_at(cosine) || cosine < std::cos(settings_.max_incidence_deg * kDegree))
    return {kNoReturn, 0.0};
  constexpr double kBlack = 0.02;
  const double light = std::max(kBlack, static_cast<double>(surface.reflectivity)) * cosine;
  const double reach_m = settings_.max_range_2pct_m * std::sqrt(light / kBlack);
  if (dust_.equivalent_clear_distance_m(hit->distance_m) > reach_m) return {kNoReturn, 0.0};
  return {hit->distance_m, light};
}

/// Returns the mean over the beam width at this range, weighted by the returned light.
PanoramicScanner::Return PanoramicScanner::mixed_pixel_return(const Pose3& T_world_scanner,
                                                              const Eigen::Vector3d& direction, double range_m) const {
  const double quarter_rad =
      (0.5 * settings_.beam_exit_diameter_m + settings_.beam_divergence_rad * range_m) / (2.0 * range_m);
  const Eigen::Vector3d aside = direction.unitOrthogonal(), across = direction.cross(aside);
  double returned = 0.0, range_sum = 0.0, light_sum = 0.0;
  for (const double i : {-1.0, 1.0}) {
    for (const double j : {-1.0, 1.0}) {
      const Return part = trace(T_world_scanner, (direction + quarter_rad * (i * aside + j * across)).normalized());
      if (!std::isfinite(part.range_m)) continue;
      const double weight = part.light / (part.range_m * part.range_m);
      returned += weight;
      range_sum += weight * part.range_m;
      light_sum += 0.25 * part.light;
    }
  }
  return returned > 0.0 ? Return{range_sum / returned, light_sum} : Return{kNoReturn, 0.0};
}

double PanoramicScanner::range_std_m(const Return& beam_return) const {
  const double gray_m = settings_.gray_noise_std_m *
                        std::sqrt(dust_.equivalent_clear_distance_m(beam_return.range_m) / 10.0) * 0.1 /
                        beam_return.light;
  return std::hypot(settings_.range_noise_std_m, gray_m);
}

namespace {

class ScannerOnBody : public Sensor {
 public:
  explicit ScannerOnBody(const SensorContext& context)
      : scanner_(context.settings.scanner, context.scene, context.robot.T_body("scanner"), context.seed,
                 context.settings.dust, context.as_built.scanner()) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    if (!scanner_.is_busy()) return;
    const auto timer = tick.clock.time_stage("scanner");
    scanner_.advance(tick.last, tick.now, tick.T_world_body_last, tick.T_world_body);
    for (PanoramicScan& scan : scanner_.take_scans()) readings.emplace_back(std::move(scan));
  }
  void command(const InstrumentCommand& command, Time now, const Pose3& T_world_body) override {
    if (std::holds_alternative<ScanCommand>(command)) scanner_.begin(now, T_world_body);
  }
  bool is_busy() const override { return scanner_.is_busy(); }

  void serialize_state(StateArchive& archive) override { archive(scanner_); }

 private:
  PanoramicScanner scanner_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<PanoramicScan>(const SensorContext& context) {
  return context.settings.scanner.enabled ? std::make_unique<ScannerOnBody>(context) : nullptr;
}

}  // namespace patrol::sim
