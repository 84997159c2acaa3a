#include "app/realism/realism_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/realism/realism_map.h"

namespace patrol::app {
namespace {

using realism::BeamClass;
using realism::ResidualBin;
using report::SeriesColor;

std::string millimeters(double value_m) { return fmt::format("{:.1f}", 1e3 * value_m); }

report::KeyMetrics realism_key_metrics(const RealismResult& result) {
  const realism::ResidualDistribution recorded = result.residual(), simulated = result.simulated_residual();
  return {{{"median |residual| on static surfaces", millimeters(recorded.median_abs_m), "mm",
            fmt::format("simulated: {} mm", millimeters(simulated.median_abs_m))},
           {"95 % of |residual| below", millimeters(recorded.p95_abs_m), "mm",
            fmt::format("simulated: {} mm", millimeters(simulated.p95_abs_m))},
           {"median residual (bias)", millimeters(recorded.median_m), "mm",
            fmt::format("simulated: {} mm", millimeters(simulated.median_m))},
           {"Kolmogorov-Smirnov distance", fmt::format("{:.3f}", result.ks()), "",
            "between recorded and simulated residuals; 0: equal"}}};
}

/// Normalized histogram in percent per millimeter.
report::Curve histogram(const std::vector<double>& residuals_m, const char* name, SeriesColor color, bool is_dashed,
                        double half_m) {
  constexpr int kBins = 120;
  std::vector<double> counts(kBins, 0.0);
  const double width_m = 2.0 * half_m / kBins;
  for (const double residual_m : residuals_m) {
    const double bin = std::floor((residual_m + half_m) / width_m);
    if (bin >= 0.0 && bin < kBins) counts[static_cast<std::size_t>(bin)] += 1.0;
  }
  report::Curve curve{.name = name, .color = color, .is_dashed = is_dashed, .points = {}};
  const double scale = 100.0 / (std::max<double>(1.0, static_cast<double>(residuals_m.size())) * 1e3 * width_m);
  for (int b = 0; b < kBins; ++b)
    curve.points.emplace_back(1e3 * (-half_m + (b + 0.5) * width_m), scale * counts[static_cast<std::size_t>(b)]);
  return curve;
}

report::LinePlot histogram_plot(const RealismResult& result) {
  const double half_m =
      std::clamp(1.2 * std::max(result.residual().p95_abs_m, result.simulated_residual().p95_abs_m), 0.02, 0.3);
  return {.title = "Residuals on static surfaces",
          .unit = "% per mm",
          .axis = {.label = "recorded minus expected range, mm", .max = 1e3 * half_m, .min = -1e3 * half_m},
          .max = {},
          .curves = {histogram(residuals_of(result.recorded.set.beams, BeamClass::kStatic), "recorded",
                               SeriesColor::kEstimate, false, half_m),
                     histogram(residuals_of(result.simulated.set.beams, BeamClass::kStatic), "simulated",
                               SeriesColor::kTruth, true, half_m)},
          .marks = {},
          .spans = {}};
}

constexpr std::size_t kMinShown = 30;  ///< beams of a bin from which on it is shown

/// Curve over the bins with enough beams.
report::Curve bin_curve(const std::vector<ResidualBin>& bins, const char* name, SeriesColor color, bool is_dashed,
                        double (*value)(const ResidualBin&)) {
  report::Curve curve{.name = name, .color = color, .is_dashed = is_dashed, .points = {}};
  for (const ResidualBin& bin : bins) {
    if (bin.num_expected >= kMinShown) curve.points.emplace_back(0.5 * (bin.low + bin.high), value(bin));
  }
  return curve;
}

/// Limits of the bins with enough beams.
std::pair<double, double> shown_range(const std::vector<ResidualBin>& bins) {
  std::pair<double, double> shown = {bins.back().high, bins.front().low};
  for (const ResidualBin& bin : bins) {
    if (bin.num_expected >= kMinShown) shown = {std::min(shown.first, bin.low), std::max(shown.second, bin.high)};
  }
  return shown.first < shown.second ? shown : std::pair(bins.front().low, bins.back().high);
}

report::LinePlot bin_plot(const BinnedResiduals& group, const std::string& title, const std::string& unit,
                          double (*value)(const ResidualBin&)) {
  return {.title = fmt::format("{} by {}", title, group.name),
          .unit = unit,
          .axis = {.label = fmt::format("{}, {}", group.name, group.unit),
                   .max = shown_range(group.recorded).second,
                   .min = shown_range(group.recorded).first},
          .max = {},
          .curves = {bin_curve(group.recorded, "recorded", SeriesColor::kEstimate, false, value),
                     bin_curve(group.simulated, "simulated", SeriesColor::kTruth, true, value)},
          .marks = {},
          .spans = {}};
}

std::vector<report::Block> plots_of(const std::vector<BinnedResiduals>& groups) {
  std::vector<report::Block> plots;
  for (const BinnedResiduals& group : groups) {
    plots.emplace_back(
        bin_plot(group, "Median residual", "mm", [](const ResidualBin& bin) { return 1e3 * bin.residual.median_m; }));
    plots.emplace_back(bin_plot(group, "Robust standard deviation", "mm",
                                [](const ResidualBin& bin) { return 1e3 * bin.residual.spread_m; }));
    plots.emplace_back(
        bin_plot(group, "Drop-outs", "%", [](const ResidualBin& bin) { return 100.0 * bin.dropout_rate(); }));
  }
  return plots;
}

report::TableBlock class_table(const RealismResult& result) {
  static constexpr std::array<const char*, realism::kBeamClassNames.size()> kMeanings = {
      "return within the limit of a smooth surface: the residuals of this page",
      "return beside a jump of the expected range or a corner: mixed pixels",
      "no return from an expected surface",
      "isolated return before the surface: false return",
      "far from the expected surface, as its neighbor: excluded from the static surfaces",
      "isolated return far behind the surface",
      "return where the site has no surface",
      "neither return nor surface",
      "glass: passes light off its normal",
      "below the minimum range"};
  report::TableBlock table{.caption = "Beams by class",
                           .columns = {{"class"}, {"recorded", true}, {"simulated", true}, {"meaning"}},
                           .rows = {}};
  const auto percent = [](const std::vector<realism::Beam>& beams, BeamClass kind) {
    return fmt::format("{:.2f} %", 100.0 * static_cast<double>(count_of(beams, kind)) /
                                       std::max<double>(1.0, static_cast<double>(beams.size())));
  };
  for (std::size_t k = 0; k < realism::kBeamClassNames.size(); ++k) {
    const auto kind = static_cast<BeamClass>(k);
    table.rows.push_back({{realism::kBeamClassNames[k]},
                          {percent(result.recorded.set.beams, kind)},
                          {percent(result.simulated.set.beams, kind)},
                          {kMeanings[k], report::Tone::kFaint}});
  }
  return table;
}

report::CollapsibleTables bin_tables(const std::vector<BinnedResiduals>& groups) {
  report::CollapsibleTables tables{.summary = "Tables by range, incidence and azimuth", .tables = {}};
  for (const BinnedResiduals& group : groups) {
    report::TableBlock table{.caption = fmt::format("By {}, {}; residuals in mm", group.name, group.unit),
                             .columns = {{"from", true},
                                         {"to", true},
                                         {"beams", true},
                                         {"median", true},
                                         {"95 % |.|", true},
                                         {"robust std", true},
                                         {"drop-outs", true},
                                         {"simulated median", true},
                                         {"95 % |.|", true},
                                         {"robust std", true},
                                         {"drop-outs", true}},
                             .rows = {}};
    for (std::size_t b = 0; b < group.recorded.size(); ++b) {
      const ResidualBin &bin = group.recorded[b], &simulated = group.simulated[b];
      if (bin.num_expected == 0) continue;
      std::vector<report::TableCell> row = {
          {fmt::format("{:g}", bin.low)}, {fmt::format("{:g}", bin.high)}, {std::to_string(bin.num_expected)}};
      for (const ResidualBin* each : {&bin, &simulated}) {
        row.push_back({millimeters(each->residual.median_m)});
        row.push_back({millimeters(each->residual.p95_abs_m)});
        row.push_back({millimeters(each->residual.spread_m)});
        row.push_back({fmt::format("{:.2f} %", 100.0 * each->dropout_rate())});
      }
      table.rows.push_back(std::move(row));
    }
    tables.tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace

report::Page realism_page(const RealismContents& contents, const RealismResult& result) {
  const std::vector<BinnedResiduals> groups = binned_residuals(result);
  report::Page page{.kind = contents.kind,
                    .title = contents.title,
                    .facts = contents.facts,
                    .sections = contents.first,
                    .footer = "Generated by patrol. All figures are also in metrics.json and residuals.csv."};
  report::Section summary{.title = contents.first.empty() ? "" : "Recorded against simulated beams",
                          .blocks = {realism_key_metrics(result)}};
  for (const std::string& note : contents.notes) summary.blocks.emplace_back(report::TextBlock{note});
  page.sections.push_back(std::move(summary));
  page.sections.push_back(
      {"Map of the residuals",
       {residual_map(result.recorded.set),
        report::TextBlock{"Returns on static surfaces at their expected points, in cells of 5 cm."}}});
  report::Section scans{.title = "Scans", .blocks = {}};
  const std::size_t count = result.recorded.set.scans.size();
  for (const std::size_t scan : {count / 6, count / 2, 5 * count / 6})
    scans.blocks.emplace_back(scan_overlay(result.recorded.set, result.simulated.set, scan));
  page.sections.push_back(std::move(scans));
  report::Section plots{.title = "Distributions", .blocks = {histogram_plot(result)}};
  for (report::Block& block : plots_of(groups)) plots.blocks.push_back(std::move(block));
  page.sections.push_back(std::move(plots));
  page.sections.push_back({"Tables", {class_table(result), bin_tables(groups)}});
  return page;
}

}  // namespace patrol::app
