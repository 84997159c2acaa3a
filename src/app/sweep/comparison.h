#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_rows.h"
#include "score/statistics.h"

namespace patrol::app {

/// One variant's figure over the seeds, and how it differs from the first variant's.
struct VariantFigure {
  std::size_t variant = 0;
  std::size_t num_runs = 0;                    ///< that gave the figure
  double mean = 0.0;
  std::optional<score::Interval> interval;     ///< of the mean, 95 %
  std::size_t num_pairs = 0;                   ///< seeds for which both variants gave the figure
  std::optional<score::Interval> difference;   ///< of the paired differences' mean; none for the first variant
  /// "lower", "higher", "no difference" (the interval holds zero), "too few pairs"; empty for the first variant.
  std::string verdict;
};

/// [variant], of the runs of the first `num_seeds` seeds. The same seeds meet the same noise in all variants, and a difference within pairs
/// has less of it than one between means. `level` is that of the difference's interval.
std::vector<VariantFigure> compare(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric,
                                   std::size_t num_seeds, double level = 0.95);

/// How far a sweep has to go, and which of its runs count.
struct SweepProgress {
  std::vector<std::size_t> needed;   ///< runs that are still to do, before anything more can be said
  std::vector<std::size_t> counted;  ///< runs that the result is made of, in the manifest's order
  std::vector<std::size_t> num_seeds;  ///< [variant] that were run for it
};

/// Without early stopping every run counts. With it, variants are looked at after 5, 10, 20, 40 ... seeds: one whose difference of the first
/// metric is decided (its interval holds no zero, or lies within the margin) is run no further. So that looking often does not decide too
/// often, each of the k looks takes an interval of level 1 - 0.05 / k (Bonferroni). What is decided depends on the rows alone, never on
/// who ran them or when.
SweepProgress progress_of(const SweepManifest& manifest, const SweepRows& rows);

/// Of the intervals of a sweep's differences: 0.95, or with early stopping that of each look.
double level_of(const SweepManifest& manifest);

/// Numbers of seeds after which a sweep looks.
std::vector<std::size_t> looks_of(std::size_t num_seeds);

}  // namespace patrol::app
