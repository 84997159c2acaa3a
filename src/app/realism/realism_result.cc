#include "app/realism/realism_result.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/geometry/angles.h"

namespace patrol::app {
namespace {

using realism::Beam;
using realism::BeamClass;

constexpr double kMinStaticRatio = 0.5;  ///< smaller ratios are worth a warning

double rate_of(const std::vector<Beam>& beams, BeamClass kind, bool (*is_counted)(const Beam&)) {
  std::size_t count = 0, total = 0;
  for (const Beam& beam : beams) {
    if (!is_counted(beam)) continue;
    ++total;
    count += beam.kind == kind ? 1 : 0;
  }
  return total == 0 ? 0.0 : static_cast<double>(count) / static_cast<double>(total);
}

bool is_on_smooth(const Beam& beam) { return beam.expected.is_smooth && beam.kind != BeamClass::kGlass; }
bool is_any(const Beam&) { return true; }

io::Metrics to_metrics(const realism::ResidualDistribution& residual) {
  return {{"count", residual.count},
          {"median_m", residual.median_m},
          {"median_abs_m", residual.median_abs_m},
          {"p95_abs_m", residual.p95_abs_m},
          {"robust_std_m", residual.spread_m}};
}

/// Residuals of all returns with an expected surface, whatever their class.
std::vector<double> all_residuals(const std::vector<Beam>& beams) {
  std::vector<double> residuals;
  for (const Beam& beam : beams) {
    if (beam.is_return() && beam.expected.has_surface()) residuals.push_back(beam.residual_m());
  }
  return residuals;
}

io::Metrics metrics_of(const std::vector<Beam>& beams) {
  io::Metrics metrics = {{"beams", beams.size()},
                         {"static", to_metrics(realism::distribution_of(residuals_of(beams, BeamClass::kStatic)))},
                         {"edge", to_metrics(realism::distribution_of(residuals_of(beams, BeamClass::kEdge)))},
                         {"all_returns", to_metrics(realism::distribution_of(all_residuals(beams)))},
                         {"dropout_rate", rate_of(beams, BeamClass::kDropout, is_on_smooth)},
                         {"moving_rate", rate_of(beams, BeamClass::kMoving, is_on_smooth)}};
  for (std::size_t k = 0; k < realism::kBeamClassNames.size(); ++k)
    metrics["classes"][realism::kBeamClassNames[k]] = count_of(beams, static_cast<BeamClass>(k));
  return metrics;
}

io::Metrics to_metrics(const std::vector<Eigen::Vector3d>& corrections) {
  std::vector<double> moved_m, turned_deg;
  for (const Eigen::Vector3d& correction : corrections) {
    moved_m.push_back(correction.head<2>().norm());
    turned_deg.push_back(std::abs(correction.z()) * kDegPerRad);
  }
  const realism::ResidualDistribution moved = realism::distribution_of(moved_m),
                                      turned = realism::distribution_of(turned_deg);
  return {{"scans", corrections.size()},
          {"median_m", moved.median_m},
          {"p95_m", moved.p95_abs_m},
          {"median_deg", turned.median_m},
          {"p95_deg", turned.p95_abs_m}};
}

}  // namespace

realism::ResidualDistribution RealismResult::residual() const {
  return realism::distribution_of(residuals_of(recorded.set.beams, BeamClass::kStatic));
}
realism::ResidualDistribution RealismResult::simulated_residual() const {
  return realism::distribution_of(residuals_of(simulated.set.beams, BeamClass::kStatic));
}
double RealismResult::ks() const {
  return realism::ks_distance(residuals_of(recorded.set.beams, BeamClass::kStatic),
                              residuals_of(simulated.set.beams, BeamClass::kStatic));
}

realism::PositionedScans simulate_like(const realism::Site& site, const realism::PositionedScans& recorded,
                                       const realism::LidarDevice& device, const realism::PositionSettings& settings,
                                       std::uint64_t seed,
                                       const std::function<bool(std::size_t, std::size_t)>& on_scan) {
  std::vector<realism::PosedScan> scans = recorded.set.scans;
  const std::vector<std::vector<float>> ranges_m = simulate_scans(site, device, scans, seed);
  for (std::size_t k = 0; k < scans.size(); ++k) scans[k].scan.ranges_m = ranges_m[k];
  return position_scans(site, scans, settings, on_scan);
}

std::vector<BinnedResiduals> binned_residuals(const RealismResult& result) {
  double max_range_m = 1.0;
  for (const Beam& beam : result.recorded.set.beams) {
    if (beam.kind == BeamClass::kStatic) max_range_m = std::max(max_range_m, beam.expected.range_m);
  }
  const std::vector<realism::PosedScan>& scans = result.recorded.set.scans;
  const auto range_m = [](const Beam& beam) { return beam.expected.range_m; };
  const auto incidence_deg = [](const Beam& beam) { return to_deg(std::acos(std::min(1.0, beam.expected.cosine))); };
  const auto azimuth_deg = [&](const Beam& beam) {
    return to_deg(wrap_angle(scans[beam.scan].azimuth_rad(beam.index)));
  };
  const auto group = [&](const char* name, const char* unit, const std::function<double(const Beam&)>& value,
                         double low, double width, std::size_t count) {
    return BinnedResiduals{.name = name,
                           .unit = unit,
                           .recorded = bins_of(result.recorded.set.beams, value, low, width, count),
                           .simulated = bins_of(result.simulated.set.beams, value, low, width, count)};
  };
  return {group("range", "m", range_m, 0.0, 1.0, static_cast<std::size_t>(std::ceil(max_range_m))),
          group("incidence", "deg", incidence_deg, 0.0, 5.0, 18),
          group("azimuth", "deg", azimuth_deg, -180.0, 10.0, 36)};
}

io::Table residual_table(const std::vector<BinnedResiduals>& groups) {
  io::Table table{.name = "residuals",
                  .columns = {"by", "low", "high", "expected", "static", "median_m", "median_abs_m", "p95_abs_m",
                              "robust_std_m", "dropout_rate", "moving", "simulated_static", "simulated_median_m",
                              "simulated_median_abs_m", "simulated_p95_abs_m", "simulated_robust_std_m",
                              "simulated_dropout_rate"},
                  .rows = {}};
  const auto integer = [](std::size_t count) { return static_cast<std::int64_t>(count); };
  for (const BinnedResiduals& group : groups) {
    for (std::size_t b = 0; b < group.recorded.size(); ++b) {
      const realism::ResidualBin &bin = group.recorded[b], &simulated = group.simulated[b];
      if (bin.num_expected == 0) continue;
      table.rows.push_back({group.name, bin.low, bin.high, integer(bin.num_expected), integer(bin.residual.count),
                            bin.residual.median_m, bin.residual.median_abs_m, bin.residual.p95_abs_m,
                            bin.residual.spread_m, bin.dropout_rate(), integer(bin.num_moving),
                            integer(simulated.residual.count), simulated.residual.median_m,
                            simulated.residual.median_abs_m, simulated.residual.p95_abs_m, simulated.residual.spread_m,
                            simulated.dropout_rate()});
    }
  }
  return table;
}

io::Metrics metrics_of(const RealismResult& result) {
  io::Metrics metrics = {{"scans", result.recorded.set.scans.size()},
                         {"recorded", metrics_of(result.recorded.set.beams)},
                         {"simulated", metrics_of(result.simulated.set.beams)},
                         {"ks_distance", result.ks()}};
  metrics["smooth_ratio"] = rate_of(result.recorded.set.beams, BeamClass::kStatic, is_any);
  if (!result.recorded.corrections.empty()) {
    metrics["alignment"] = to_metrics(result.recorded.corrections);
    metrics["alignment"]["absorbed_bias"] = result.recorded.set.absorbed_bias;
    metrics["alignment"]["range_offset_m"] = result.recorded.errors.range_offset_m;
  }
  return metrics;
}

double static_ratio(const std::vector<Beam>& beams) {
  const auto num_static = static_cast<double>(count_of(beams, BeamClass::kStatic));
  const auto num_moving = static_cast<double>(count_of(beams, BeamClass::kMoving));
  return num_static + num_moving == 0.0 ? 0.0 : num_static / (num_static + num_moving);
}

std::string summary_text(const RealismResult& result) {
  const realism::ResidualDistribution recorded = result.residual(), simulated = result.simulated_residual();
  const auto row = [](const char* name, const realism::ResidualDistribution& residual, double dropout) {
    return fmt::format("{:<10} {:>8} {:>9.1f} {:>11.1f} {:>9.1f} {:>11.1f} {:>10.2f}\n", name, residual.count,
                       1e3 * residual.median_m, 1e3 * residual.median_abs_m, 1e3 * residual.p95_abs_m,
                       1e3 * residual.spread_m, 100.0 * dropout);
  };
  return fmt::format("{:<10} {:>8} {:>9} {:>11} {:>9} {:>11} {:>10}\n", "", "beams", "median mm", "median |mm|",
                     "95 % |mm|", "robust std", "drop-out %") +
         row("recorded", recorded, rate_of(result.recorded.set.beams, BeamClass::kDropout, is_on_smooth)) +
         row("simulated", simulated, rate_of(result.simulated.set.beams, BeamClass::kDropout, is_on_smooth)) +
         fmt::format(
             "Kolmogorov-Smirnov distance of the residuals on static surfaces: {:.3f}\n"
             "moving or unmapped: {:.1f} % of the beams on smooth surfaces\n",
             result.ks(), 100.0 * rate_of(result.recorded.set.beams, BeamClass::kMoving, is_on_smooth)) +
         (static_ratio(result.recorded.set.beams) < kMinStaticRatio
              ? "warning: most beams are not on surfaces of the site: --site and --trajectory must be those of the "
                "log\n"
              : "");
}

}  // namespace patrol::app
