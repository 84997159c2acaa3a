#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/campaign/sweep/sweep_rows.h"
#include "score/statistics.h"

namespace patrol::app {

/// Metric of one variant over the seeds, with its difference from the first variant.
struct VariantMetric {
  std::size_t variant = 0;
  std::size_t num_runs = 0;    ///< runs with a value of the metric that did not fail
  std::size_t num_failed = 0;  ///< runs that failed; they are left out
  std::size_t num_seeds = 0;
  double mean = 0.0;
  std::optional<score::Interval> interval;    ///< 95 % interval of the mean
  std::size_t num_pairs = 0;                  ///< seeds for which both variants have a value
  std::optional<score::Interval> difference;  ///< mean of the paired differences; none for the first variant
  /// p-value of a difference of zero, adjusted for the number of variants [Holm79]; none for the first variant
  std::optional<double> p_adjusted;
  /// "lower", "higher", "no difference" (p_adjusted is not below 1 - level), "too few pairs", or "runs failed" if those
  /// are the reason for too few; empty for the first variant.
  std::string verdict;

  /// Number of failed runs: "3 of 3"; "0" without one.
  std::string failed_text() const;
};

/// Compares the variants over the runs of the first `num_seeds` seeds, [variant]. Equal seeds give equal noise in all
/// variants, so that paired differences have less variance than differences of means. `level`: confidence level of the
/// difference's interval.
std::vector<VariantMetric> compare(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric,
                                   std::size_t num_seeds, double level = 0.95);

/// Runs that a sweep still needs, and runs that count.
struct SweepProgress {
  std::vector<std::size_t> needed;     ///< runs that are required for the next decision
  std::vector<std::size_t> counted;    ///< runs of the result, in the manifest's order
  std::vector<std::size_t> num_seeds;  ///< [variant], number of seeds run
};

/// Selects the runs that count. Without early stopping, every run counts. With it, interim analyses follow after 5, 10,
/// 20, 40 ... seeds. A variant is stopped when the difference of the first metric is decided: its interval excludes
/// zero, or lies within the margin. Each of the k analyses uses an interval of level 1 - 0.05 / k (Bonferroni), which
/// limits the error probability of all together. The decisions depend on the rows alone, not on the order or the
/// process of the runs.
SweepProgress evaluate_progress(const SweepManifest& manifest, const SweepRows& rows);

/// Confidence level of the intervals of a sweep's differences: 0.95, or with early stopping that of each interim
/// analysis.
double confidence_level(const SweepManifest& manifest);

/// Numbers of seeds after which interim analyses are made.
std::vector<std::size_t> interim_analyses(std::size_t num_seeds);

}  // namespace patrol::app
