#include "app/study/lidar_study.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "realism/planted_lidar.h"

namespace patrol::app {
namespace {

struct LidarVariant {
  const char* name;
  realism::PlantedTrialSettings settings;
};

const std::vector<LidarVariant>& lidar_variants() {
  static const std::vector<LidarVariant> kVariants = {
      {"exact path", {}},
      {"path off by 3 cm and 0.5 deg, scans aligned", {.path_std_m = 0.03, .path_yaw_std_deg = 0.5}},
      {"one plain room, exact path", {.is_plain_room = true}}};
  return kVariants;
}

/// Parameters by their names in the fit.
const std::vector<std::string>& planted_names() {
  static const std::vector<std::string> kNames = {
      "range_noise_std_m",    "wide_noise_probability",  "wide_noise_std_m",        "range_quantization_m",
      "angle_noise_std_deg",  "beam_width_deg",          "dropout_probability",     "max_incidence_deg",
      "max_range_10pct_m",    "false_return_rate_per_m", "measured_range_offset_m", "measured_range_scale",
      "measured_incidence_m", "measured_reflectivity_m"};
  return kNames;
}

/// Metrics of a trial: fraction of the intervals that hold; then for each parameter whether its interval holds, and
/// whether it is observable.
std::vector<double> metrics_of_trial(const realism::PlantedTrial& trial) {
  std::vector<double> holds, observed;
  double sum = 0.0;
  for (const std::string& name : planted_names()) {
    const realism::FittedParameter& fitted = trial.fit.of(name);
    for (const auto& [planted, value] : trial.values) {
      if (planted != name) continue;
      holds.push_back(fitted.contains(value) ? 1.0 : 0.0);
      observed.push_back(fitted.is_seen ? 1.0 : 0.0);
      sum += holds.back();
    }
  }
  std::vector<double> metrics = {sum / static_cast<double>(holds.size())};
  metrics.insert(metrics.end(), holds.begin(), holds.end());
  metrics.insert(metrics.end(), observed.begin(), observed.end());
  return metrics;
}

studies::StudySample run_trials(std::uint64_t seed) {
  studies::StudySample sample;
  for (const LidarVariant& variant : lidar_variants()) {
    const realism::Site site = realism::planted_site(variant.settings.is_plain_room);
    sample.push_back(metrics_of_trial(run_planted_trial(site, variant.settings, seed)));
  }
  return sample;
}

report::TableBlock trial_table(const LidarVariant& variant, std::uint64_t seed) {
  const realism::Site site = realism::planted_site(variant.settings.is_plain_room);
  const realism::PlantedTrial trial = run_planted_trial(site, variant.settings, seed);
  report::TableBlock table{
      .caption = fmt::format("{}, seed {}", variant.name, seed),
      .columns = {{"setting"}, {"planted", true}, {"fitted", true}, {"95 % interval", true}, {"not observable"}},
      .rows = {}};
  for (const auto& [name, value] : trial.values) {
    const realism::FittedParameter& fitted = trial.fit.of(name);
    table.rows.push_back({{name},
                          {fmt::format("{:.4g}", value)},
                          {fitted.is_seen ? fmt::format("{:.4g}", fitted.value) : "–"},
                          {fmt::format("{:.4g} ... {:.4g}", fitted.low, fitted.high),
                           fitted.contains(value) ? report::Tone::kPlain : report::Tone::kBad},
                          {fitted.reason, report::Tone::kFaint}});
  }
  return table;
}

}  // namespace

studies::Study lidar_study() {
  studies::Study study{.name = "lidar-calibration",
                       .title = "Planted settings of a lidar, recovered from its scans",
                       .source = "none: acceptance of patrol calibrate --sensor lidar",
                       .conditions =
                           "60 scans of 720 beams in a site with rooms, posts and dark surfaces; settings, "
                           "poses and errors drawn by the seed. Intervals are meant to hold in 95 % of the "
                           "trials.",
                       .default_seeds = 40};
  study.metrics.push_back({.name = "all: interval holds", .unit = ""});
  for (const std::string& name : planted_names())
    study.metrics.push_back({.name = name + ": interval holds", .unit = ""});
  for (const std::string& name : planted_names()) study.metrics.push_back({.name = name + ": observable", .unit = ""});
  for (const LidarVariant& variant : lidar_variants())
    study.variants.push_back({.world = "planted site", .method = variant.name});
  study.run = run_trials;
  study.illustrate = [](std::uint64_t seed) {
    report::Section section{.title = "Trials", .blocks = {}};
    for (const LidarVariant& variant : lidar_variants()) section.blocks.emplace_back(trial_table(variant, seed));
    return std::vector<report::Section>{std::move(section)};
  };
  return study;
}

}  // namespace patrol::app
