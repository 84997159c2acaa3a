#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/sweep/sweep_rows.h"
#include "io/table.h"
#include "score/statistics.h"

namespace patrol::app {

/// How much of a figure goes away with one imperfection.
struct BudgetShare {
  std::string name;
  std::size_t num_pairs = 0;               ///< seeds that gave the figure with it and without
  std::optional<score::Interval> share;    ///< figure with all imperfections less the figure without this one, 95 %, paired by seed
};

/// Who owns how much of one figure. The manifest's first variant is the scenario as it is, its last has every imperfection taken away, those
/// between have one taken away each.
struct Budget {
  std::string metric;
  std::optional<score::Interval> as_it_is;
  std::optional<score::Interval> ideal;        ///< with every imperfection taken away
  std::vector<BudgetShare> shares;             ///< largest first
  std::optional<score::Interval> sum;          ///< of the shares
  std::optional<score::Interval> interaction;  ///< what all take away together beyond the sum: imperfections that hide or feed each other
};

/// Of each of the manifest's metrics.
std::vector<Budget> make_budgets(const SweepManifest& manifest, const SweepRows& rows);
Budget make_budget(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric);

/// A waterfall for a screen: from the figure as it is, share by share, to the ideal one.
std::string budget_text(const Budget& budget);

/// All budgets, one row a share, and rows "as it is", "sum", "interaction", "all ideal".
io::Table budget_table(const std::vector<Budget>& budgets);

}  // namespace patrol::app
