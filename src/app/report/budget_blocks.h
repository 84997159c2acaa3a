#pragma once

#include "app/sweep/budget.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// A waterfall from the figure as it is to the ideal one, share by share, and in figures.
std::vector<render::Block> budget_blocks(const Budget& budget);

/// What owns most, in a sentence.
std::string budget_finding(const Budget& budget);

}  // namespace patrol::app
