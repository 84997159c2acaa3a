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
  /// p-value of the difference, adjusted for the number of comparisons of the study [Holm79]
  std::optional<double> adjusted_p_value;
  std::size_t num_seeds = 0;  ///< seeds with a value of the metric
  /// p-value of equal failure rates of variant and reference by the sign test over the seeds on which one of them
  /// failed, adjusted with the others; only for the first metric, and only if there is such a seed
  std::optional<double> adjusted_failure_p_value;
  std::size_t num_failed = 0;  ///< failed seeds, that is, without a value of the study's first metric
  std::size_t num_paired = 0;  ///< seeds on which both the variant and its reference have a value
};

/// Numbers of comparisons of a study at a level of 5 %.
struct ComparisonCount {
  std::size_t num_comparisons = 0;          ///< compared metrics of variants that are not their own reference
  std::size_t num_significant = 0;          ///< differences after the correction for their number
  std::size_t num_uncorrected = 0;          ///< differences whose own 95 % interval does not contain zero
  std::size_t num_untested = 0;             ///< comparisons with fewer than two pairs
  std::size_t num_failure_comparisons = 0;  ///< comparisons of failure rates, in the same family
  std::size_t num_failure_differences = 0;  ///< different failure rates after the correction
};

/// [variant][metric]
using StudyResults = std::vector<std::vector<StudyResult>>;

/// Computes the statistics. `samples`: [seed].
StudyResults summarize(const Study& study, const std::vector<StudySample>& samples);

/// Counts the comparisons of a study.
ComparisonCount count_comparisons(const Study& study, const StudyResults& results);

/// The count as a sentence, for the table, the page and the documentation.
std::string comparison_text(const Study& study, const StudyResults& results);

/// "lower", "higher" or "no difference" (the adjusted p-value is above 5 %); empty without a comparison.
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
