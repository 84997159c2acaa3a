#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/study.h"
#include "io/table.h"
#include "score/statistics.h"

namespace patrol::app {

/// One figure of one variant over the seeds.
struct StudyResult {
  double mean = 0.0;
  std::optional<score::Interval> interval;    ///< of the mean, 95 %
  std::optional<score::Interval> difference;  ///< from the variant's reference, paired by seed, 95 %
  std::size_t num_seeds = 0;                  ///< that gave the figure
};

/// [variant][figure]
using StudyResults = std::vector<std::vector<StudyResult>>;

/// `samples` [seed].
StudyResults summarize(const Study& study, const std::vector<StudySample>& samples);

/// "lower", "higher" or "no difference" (the interval holds zero); empty where nothing is compared.
std::string verdict_of(const StudyResult& result);

/// One row a variant and figure; what the clock says stands in `performance`, all else in `results`: the same seeds give the same bytes.
io::Table results_table(const Study& study, const StudyResults& results);
io::Table performance_table(const Study& study, const StudyResults& results);
/// One row a seed and variant.
io::Table samples_table(const Study& study, const std::vector<std::uint64_t>& seeds, const std::vector<StudySample>& samples);

/// For a screen: a table for each world.
std::string results_text(const Study& study, const StudyResults& results);

/// For people: tables by world, box plots of the first figure, and the study's own pictures.
render::Page study_page(const Study& study, const std::vector<std::uint64_t>& seeds, const std::vector<StudySample>& samples, const StudyResults& results);

}  // namespace patrol::app
