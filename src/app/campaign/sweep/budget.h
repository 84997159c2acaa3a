#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/campaign/sweep/sweep_rows.h"
#include "io/files/table.h"
#include "score/statistics.h"

namespace patrol::app {

/// Contribution of one error source to a metric.
struct Contribution {
  std::string name;
  std::size_t num_pairs = 0;             ///< seeds for which the metric exists with and without the error source
  std::optional<score::Interval> value;  ///< baseline minus metric without this error source; 95 %, paired by seed
  /// p-value of a contribution of zero, adjusted for the number of error sources [Holm79]
  std::optional<double> p_adjusted;

  bool is_significant() const { return p_adjusted && *p_adjusted < 0.05; }
};

/// Error budget of one metric. The manifest's first variant is the unchanged scenario (baseline), the last one has
/// every error source removed, the others one each.
struct Budget {
  std::string metric;
  std::optional<score::Interval> baseline;
  std::optional<score::Interval> ideal;        ///< metric with every error source removed
  std::vector<Contribution> contributions;     ///< largest first
  std::optional<score::Interval> sum;          ///< sum of the contributions
  std::optional<score::Interval> interaction;  ///< effect of removing all together minus the sum of the contributions
};

/// First significant contribution in the order of the budget; null if none is significant.
const Contribution* first_significant(const Budget& budget);

/// Error budgets of all metrics of the manifest.
std::vector<Budget> make_budgets(const SweepManifest& manifest, const SweepRows& rows);
Budget make_budget(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric);

/// Waterfall chart as text: from the baseline, contribution by contribution, to the ideal value.
std::string budget_text(const Budget& budget);

/// Table of all budgets: one row per contribution, and rows "baseline", "sum", "interaction", "all ideal".
io::Table budget_table(const std::vector<Budget>& budgets);

}  // namespace patrol::app
