#include "app/realism/lidar_calibration.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/common/progress_bar.h"
#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

/// Returns the scans of one half of the log.
std::vector<realism::PosedScan> half_of(const RealismInput& input, bool is_second) {
  const std::vector<realism::PosedScan>& scans = input.scans.scans;
  const auto middle = scans.begin() + static_cast<std::ptrdiff_t>(scans.size() / 2);
  return is_second ? std::vector(middle, scans.end()) : std::vector(scans.begin(), middle);
}

/// Keeps a step of the calibration visible, and stops it on an interrupt.
class CalibrationProgress {
 public:
  auto of(const std::string& name) {
    return [this, name](std::size_t done, std::size_t total) {
      bar_.show(fmt::format("calibrate  {}: {} of {} scans", name, done, total),
                static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total)));
      return !guard_.is_interrupted();
    };
  }
  void show(const std::string& line) { bar_.show("calibrate  " + line); }
  bool is_interrupted() const { return guard_.is_interrupted(); }

 private:
  InterruptGuard guard_;
  ProgressBar bar_;
};

/// Remaining errors of aligned scans, which blur the limits of incidence and range.
realism::LidarFitSettings fit_settings(const LidarCalibrationSettings& settings) {
  constexpr double kAlignedYaw_deg = 0.05, kAlignedPosition_m = 0.005;
  realism::LidarFitSettings fit = settings.fit;
  if (!settings.realism.positions.align) return fit;
  fit.path_yaw_std_deg = std::max(fit.path_yaw_std_deg, kAlignedYaw_deg);
  fit.path_std_m = std::max(fit.path_std_m, kAlignedPosition_m);
  return fit;
}

/// Refuses scans on a site or a path that are not those of the log.
void check_site_fits(const std::vector<realism::Beam>& beams) {
  constexpr std::size_t kMinStaticBeams = 100;
  constexpr double kMinFitRatio = 0.2;
  const std::size_t num_static = count_of(beams, realism::BeamClass::kStatic);
  const double ratio = static_ratio(beams);
  if (ratio >= kMinFitRatio && num_static >= kMinStaticBeams) return;
  throw InputError(
      fmt::format("too few beams on surfaces of the site: {} static, {:.1f} % moving or unmapped: --site and "
                  "--trajectory must be those of the log",
                  num_static, 100.0 * (1.0 - ratio)));
}

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string yaml_bound(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : value < 0.0 ? "-.inf" : ".inf";
}

std::string interval_text(const realism::FittedParameter& p) {
  if (!std::isfinite(p.low) && !std::isfinite(p.high)) return "unbounded";
  if (!std::isfinite(p.high)) return fmt::format("from {}", number(p.low));
  return fmt::format("{} ... {}", number(p.low), number(p.high));
}

}  // namespace

std::optional<LidarCalibration> calibrate_lidar(const RealismInput& input, const LidarCalibrationSettings& settings) {
  const realism::PositionSettings& positions = settings.realism.positions;
  CalibrationProgress progress;
  const realism::PositionedScans first =
      position_scans(input.site, half_of(input, false), positions, progress.of("first half"));
  if (progress.is_interrupted()) return std::nullopt;
  check_site_fits(first.set.beams);
  progress.show("fit");
  LidarCalibration calibration;
  realism::LidarDevice base = input.source.device;
  base.settings.range_max_m = input.scans.scans.front().scan.range_max_m;
  calibration.fit = fit_lidar(input.site, first.set, base, fit_settings(settings));
  calibration.fitted = calibration.fit.device(base);
  const realism::PositionedScans second =
      position_scans(input.site, half_of(input, true), positions, progress.of("second half"));
  if (progress.is_interrupted()) return std::nullopt;
  const auto evaluated = [&](const realism::LidarDevice& device, const char* name) {
    return RealismResult{
        .recorded = second,
        .simulated = simulate_like(input.site, second, device, positions, settings.realism.seed, progress.of(name))};
  };
  calibration.by_preset = evaluated(input.source.device, "second half by the preset");
  calibration.by_fit = evaluated(calibration.fitted, "second half by the fit");
  if (progress.is_interrupted()) return std::nullopt;
  return calibration;
}

LidarPreset preset_of(const LidarCalibration& calibration, const RealismInput& input) {
  const LaserScan& scan = input.scans.scans.front().scan;
  LidarPreset preset{.lidar = calibration.fitted.settings,
                     .as_built = sim::LidarTolerances::for_preset(calibration.fitted.settings.preset)};
  LidarSettings& lidar = preset.lidar;
  lidar.beams = static_cast<int>(scan.ranges_m.size());
  lidar.fov_deg = std::clamp(std::abs(to_deg(scan.angle_increment_rad)) * lidar.beams, 1.0, 360.0);
  if (scan.scan_time_s >= 0.01 && scan.scan_time_s <= 2.0) lidar.rate_hz = 1.0 / scan.scan_time_s;
  lidar.range_min_m = std::max(0.0, scan.range_min_m);
  lidar.range_max_m = std::clamp(scan.range_max_m, 0.1, 400.0);
  const sim::LidarErrors& errors = calibration.fitted.errors;
  sim::LidarTolerances& as_built = preset.as_built;
  as_built.noise_ratio = 1.0;
  as_built.range_offset_m = as_built.range_scale = as_built.reflectivity_m = as_built.incidence_m = 0.0;
  as_built.measured_range_offset_m = errors.range_offset_m;
  as_built.measured_range_scale = errors.range_scale;
  as_built.measured_reflectivity_m = errors.reflectivity_m;
  as_built.measured_incidence_m = errors.incidence_m;
  return preset;
}

std::string misfit_warning(double ks_preset, double ks_fit) {
  constexpr double kMaxRatio = 0.5, kSmallDistance = 0.03;
  if (ks_fit <= kSmallDistance || ks_fit <= kMaxRatio * ks_preset) return "";
  return fmt::format(
      "the fitted settings do not explain the log: on the held-out half, their distance is {:.3f}, that of the preset "
      "{:.3f}; the intervals do not hold",
      ks_fit, ks_preset);
}

std::string calibration_yaml(const LidarCalibration& calibration, const std::string& comment) {
  std::string text = "# " + comment + "\n";
  for (const realism::FittedParameter& p : calibration.fit.parameters) {
    text += fmt::format("{}: {{value: {:.9g}, low: {}, high: {}, seen: {}", p.name, p.value, yaml_bound(p.low),
                        yaml_bound(p.high), p.is_seen);
    if (!p.is_seen) text += fmt::format(", reason: \"{}\"", p.reason);
    text += "}\n";
  }
  return text;
}

io::Metrics metrics_of(const LidarCalibration& calibration) {
  io::Metrics metrics = {{"hits", calibration.fit.num_hits},
                         {"edges", calibration.fit.num_edges},
                         {"outlier_ratio", calibration.fit.outlier_ratio},
                         {"edge_outlier_ratio", calibration.fit.edge_outlier_ratio}};
  for (const realism::FittedParameter& p : calibration.fit.parameters) {
    metrics["parameters"][p.name] = {{"value", p.value}, {"low", p.low}, {"high", p.high}, {"seen", p.is_seen}};
    if (!p.is_seen) metrics["parameters"][p.name]["reason"] = p.reason;
  }
  metrics["held_out"] = {{"ks_preset", calibration.by_preset.ks()},
                         {"ks_fit", calibration.by_fit.ks()},
                         {"ks_ratio", calibration.ks_ratio()},
                         {"preset", metrics_of(calibration.by_preset)},
                         {"fit", metrics_of(calibration.by_fit)}};
  const std::string warning = misfit_warning(calibration.by_preset.ks(), calibration.by_fit.ks());
  metrics["warning"] = warning.empty() ? io::Metrics() : io::Metrics(warning);
  return metrics;
}

std::string table_text(const LidarCalibration& calibration) {
  std::string text = fmt::format("{:<25} {:>11}  {:<25}\n", "", "fitted", "95 % interval");
  for (const realism::FittedParameter& p : calibration.fit.parameters) {
    text += fmt::format("{:<25} {:>11}  {:<25}", p.name, p.is_seen ? number(p.value) : "-", interval_text(p));
    text += p.is_seen ? "\n" : fmt::format(" not observable in this log: {}\n", p.reason);
  }
  text += fmt::format("{:.2f} % of the returns on smooth surfaces are outliers of the model\n",
                      100.0 * calibration.fit.outlier_ratio);
  return text + fmt::format(
                    "Kolmogorov-Smirnov distance of the residuals on the held-out half: preset {:.3f}, fitted "
                    "{:.3f} ({:.0f} % of the preset's)\n",
                    calibration.by_preset.ks(), calibration.by_fit.ks(), 100.0 * calibration.ks_ratio());
}

report::Section parameter_section(const LidarCalibration& calibration) {
  report::TableBlock table{
      .caption = "Fitted on the first half of the log",
      .columns = {{"setting"}, {"fitted", true}, {"95 % interval", true}, {"not observable in this log"}},
      .rows = {}};
  for (const realism::FittedParameter& p : calibration.fit.parameters)
    table.rows.push_back(
        {{p.name}, {p.is_seen ? number(p.value) : "–"}, {interval_text(p)}, {p.reason, report::Tone::kWarning}});
  report::TableBlock held_out{.caption = "Evaluated on the second half of the log",
                              .columns = {{"lidar"},
                                          {"Kolmogorov-Smirnov distance", true},
                                          {"median |residual|, mm", true},
                                          {"95 %, mm", true}},
                              .rows = {}};
  const auto row = [](const char* name, const std::string& ks, const realism::ResidualDistribution& residual) {
    return std::vector<report::TableCell>{{name},
                                          {ks},
                                          {fmt::format("{:.1f}", 1e3 * residual.median_abs_m)},
                                          {fmt::format("{:.1f}", 1e3 * residual.p95_abs_m)}};
  };
  held_out.rows = {row("recorded", "", calibration.by_fit.residual()),
                   row("simulated by the preset", fmt::format("{:.3f}", calibration.by_preset.ks()),
                       calibration.by_preset.simulated_residual()),
                   row("simulated by the fit", fmt::format("{:.3f}", calibration.by_fit.ks()),
                       calibration.by_fit.simulated_residual())};
  return {.title = "", .blocks = {std::move(table), std::move(held_out)}};
}

}  // namespace patrol::app
