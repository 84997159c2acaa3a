#pragma once

#include "app/campaign/sweep/budget.h"
#include "report/blocks.h"

namespace patrol::app {

/// Waterfall chart from the baseline to the ideal value by contributions, and a table of the values.
std::vector<report::Block> budget_blocks(const Budget& budget);

/// Sentence on the first significant contribution.
std::string budget_finding(const Budget& budget);

}  // namespace patrol::app
