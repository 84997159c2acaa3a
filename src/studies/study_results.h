#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/files/table.h"
#include "score/statistics.h"
#include "studies/study.h"

namespace patrol::studies {

/// Statistics of one metric of one variant over the seeds.
struct StudyResult {
  double mean = 0.0;
  std::optional<score::Interval> interval;    ///< 95 % interval of the mean
  std::optional<score::Interval> difference;  ///< from the variant's reference, paired by seed, 95 %
  std::size_t num_seeds = 0;                  ///< seeds with a value of the metric
};

/// [variant][metric]
using StudyResults = std::vector<std::vector<StudyResult>>;

/// Computes the statistics. `samples`: [seed].
StudyResults summarize(const Study& study, const std::vector<StudySample>& samples);

/// "lower", "higher" or "no difference" (the interval contains zero); empty without a comparison.
std::string verdict_of(const StudyResult& result);

/// Table with one row per variant and metric, without the metrics of processor time: equal seeds give equal bytes.
io::Table results_table(const Study& study, const StudyResults& results);
/// Table of the metrics of processor time, which are not reproducible.
io::Table performance_table(const Study& study, const StudyResults& results);
/// Table with one row per seed and variant.
io::Table samples_table(const Study& study, const std::vector<std::uint64_t>& seeds,
                        const std::vector<StudySample>& samples);

/// Results as text for a terminal, one table per world.
std::string results_text(const Study& study, const StudyResults& results);

/// Report page: tables by world, box plots of the first metric, and the study's own figures.
report::Page study_page(const Study& study, const std::vector<std::uint64_t>& seeds,
                        const std::vector<StudySample>& samples, const StudyResults& results);

}  // namespace patrol::studies
