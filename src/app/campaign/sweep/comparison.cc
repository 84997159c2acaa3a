#include "app/campaign/sweep/comparison.h"

#include <algorithm>
#include <cmath>

namespace patrol::app {
namespace {

constexpr double kError = 0.05;  ///< probability of a false difference

std::size_t seed_index(const SweepManifest& manifest, std::size_t run) { return run / manifest.variants.size(); }

std::string verdict_of(const std::optional<score::Interval>& difference) {
  if (!difference) return "too few pairs";
  if (difference->contains(0.0)) return "no difference";
  return difference->center < 0.0 ? "lower" : "higher";
}

bool is_decided(const VariantFigure& figure, double margin) {
  if (!figure.difference) return false;
  const bool is_equal = figure.difference->low > -margin && figure.difference->high < margin;
  return is_equal || !figure.difference->contains(0.0);
}

/// Collects the counted and the missing runs of an interim analysis. `num_seeds`: [variant], lower for variants that
/// were decided earlier.
void add_needed(const SweepManifest& manifest, const SweepRows& rows, const std::vector<std::size_t>& num_seeds, SweepProgress& progress) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (seed_index(manifest, i) >= num_seeds[manifest.runs[i].variant]) continue;
    progress.counted.push_back(i);
    if (!rows[i]) progress.needed.push_back(i);
  }
  progress.num_seeds = num_seeds;
}

}  // namespace

std::vector<VariantFigure> compare(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric,
                                   std::size_t num_seeds, double level) {
  const auto figures = flatten_metrics(manifest, rows, metric);
  std::vector<VariantFigure> compared;
  for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
    std::vector<double> values, differences;
    for (std::size_t seed = 0; seed < num_seeds; ++seed) {
      const std::optional<double>& value = figures[seed][variant];
      if (value) values.push_back(*value);
      if (value && figures[seed].front()) differences.push_back(*value - *figures[seed].front());
    }
    VariantFigure figure{.variant = variant,
                         .num_runs = values.size(),
                         .mean = score::mean(values),
                         .interval = score::mean_interval(values),
                         .num_pairs = differences.size(),
                         .difference = {},
                         .verdict = ""};
    if (variant > 0) {
      figure.difference = score::mean_interval(differences, level);
      figure.verdict = verdict_of(figure.difference);
    }
    compared.push_back(figure);
  }
  return compared;
}

std::vector<std::size_t> looks_of(std::size_t num_seeds) {
  std::vector<std::size_t> looks;
  for (std::size_t look = 5; look < num_seeds; look *= 2) looks.push_back(look);
  looks.push_back(num_seeds);
  return looks;
}

double level_of(const SweepManifest& manifest) {
  return 1.0 - kError / (manifest.stop.when_decided ? static_cast<double>(looks_of(manifest.seeds.size()).size()) : 1.0);
}

SweepProgress progress_of(const SweepManifest& manifest, const SweepRows& rows) {
  SweepProgress progress;
  const std::size_t all = manifest.seeds.size();
  std::vector<std::size_t> num_seeds(manifest.variants.size(), all);
  if (!manifest.stop.when_decided) {
    add_needed(manifest, rows, num_seeds, progress);
    return progress;
  }
  std::vector<bool> is_open(manifest.variants.size(), true);
  for (const std::size_t look : looks_of(all)) {
    for (std::size_t variant = 0; variant < num_seeds.size(); ++variant) {
      if (is_open[variant]) num_seeds[variant] = look;
    }
    progress = {};
    add_needed(manifest, rows, num_seeds, progress);
    if (!progress.needed.empty()) return progress;
    for (const VariantFigure& figure : compare(manifest, rows, manifest.metrics.front(), look, level_of(manifest))) {
      if (figure.variant > 0 && is_decided(figure, manifest.stop.margin)) is_open[figure.variant] = false;
    }
    if (std::none_of(is_open.begin() + 1, is_open.end(), [](bool open) { return open; })) return progress;
  }
  return progress;
}

}  // namespace patrol::app
