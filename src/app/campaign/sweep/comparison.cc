#include "app/campaign/sweep/comparison.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patrol::app {
namespace {

constexpr double kError = 0.05;  ///< probability of a false difference

std::size_t seed_index(const SweepManifest& manifest, std::size_t run) { return run / manifest.variants.size(); }

/// `has_failures`: whether runs of the variant or of the first variant failed.
std::string verdict_of(const VariantMetric& entry, bool has_failures, double level) {
  if (!entry.difference || !entry.p_adjusted) return has_failures ? "runs failed" : "too few pairs";
  if (*entry.p_adjusted >= 1.0 - level) return "no difference";
  return entry.difference->center < 0.0 ? "lower" : "higher";
}

bool is_decided(const VariantMetric& entry, double margin) {
  if (!entry.difference) return false;
  const bool is_equal = entry.difference->low > -margin && entry.difference->high < margin;
  return is_equal || !entry.difference->contains(0.0);
}

/// Collects the counted and the missing runs of an interim analysis. `num_seeds`: [variant], lower for variants that
/// were decided earlier.
void add_needed(const SweepManifest& manifest, const SweepRows& rows, const std::vector<std::size_t>& num_seeds,
                SweepProgress& progress) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (seed_index(manifest, i) >= num_seeds[manifest.runs[i].variant]) continue;
    progress.counted.push_back(i);
    if (!rows[i]) progress.needed.push_back(i);
  }
  progress.num_seeds = num_seeds;
}

}  // namespace

std::string VariantMetric::failed_text() const {
  return num_failed == 0 ? "0" : fmt::format("{} of {}", num_failed, num_seeds);
}

std::vector<VariantMetric> compare(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric,
                                   std::size_t num_seeds, double level) {
  const auto seed_values = flatten_metrics(manifest, rows, metric);
  std::vector<VariantMetric> compared;
  for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
    std::vector<double> values, differences;
    for (std::size_t seed = 0; seed < num_seeds; ++seed) {
      const std::optional<double>& value = seed_values[seed][variant];
      if (value) values.push_back(*value);
      if (value && seed_values[seed].front()) differences.push_back(*value - *seed_values[seed].front());
    }
    VariantMetric entry{.variant = variant,
                        .num_runs = values.size(),
                        .num_failed = count_failures(manifest, rows, variant, num_seeds),
                        .num_seeds = num_seeds,
                        .mean = score::mean(values),
                        .interval = score::mean_interval(values),
                        .num_pairs = differences.size(),
                        .difference = {},
                        .p_adjusted = {},
                        .verdict = ""};
    if (variant > 0) {
      entry.difference = score::mean_interval(differences, level);
      entry.p_adjusted = score::mean_p_value(differences);
    }
    compared.push_back(entry);
  }
  std::vector<std::optional<double>*> p_values;
  for (VariantMetric& entry : compared) p_values.push_back(&entry.p_adjusted);
  score::adjust_by_holm(p_values);
  for (VariantMetric& entry : compared) {
    const bool has_failures = entry.num_failed + compared.front().num_failed > 0;
    if (entry.variant > 0) entry.verdict = verdict_of(entry, has_failures, level);
  }
  return compared;
}

std::vector<std::size_t> interim_analyses(std::size_t num_seeds) {
  std::vector<std::size_t> analyses;
  for (std::size_t analysis = 5; analysis < num_seeds; analysis *= 2) analyses.push_back(analysis);
  analyses.push_back(num_seeds);
  return analyses;
}

double confidence_level(const SweepManifest& manifest) {
  return 1.0 -
         kError / (manifest.stop.is_early ? static_cast<double>(interim_analyses(manifest.seeds.size()).size()) : 1.0);
}

SweepProgress evaluate_progress(const SweepManifest& manifest, const SweepRows& rows) {
  SweepProgress progress;
  const std::size_t all = manifest.seeds.size();
  std::vector<std::size_t> num_seeds(manifest.variants.size(), all);
  if (!manifest.stop.is_early) {
    add_needed(manifest, rows, num_seeds, progress);
    return progress;
  }
  std::vector<bool> is_undecided(manifest.variants.size(), true);
  for (const std::size_t analysis : interim_analyses(all)) {
    for (std::size_t variant = 0; variant < num_seeds.size(); ++variant) {
      if (is_undecided[variant]) num_seeds[variant] = analysis;
    }
    progress = {};
    add_needed(manifest, rows, num_seeds, progress);
    if (!progress.needed.empty()) return progress;
    for (const VariantMetric& entry :
         compare(manifest, rows, manifest.metrics.front(), analysis, confidence_level(manifest))) {
      if (entry.variant > 0 && is_decided(entry, manifest.stop.equivalence_margin)) is_undecided[entry.variant] = false;
    }
    if (std::none_of(is_undecided.begin() + 1, is_undecided.end(), [](bool open) { return open; })) return progress;
  }
  return progress;
}

}  // namespace patrol::app
