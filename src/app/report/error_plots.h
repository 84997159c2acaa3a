#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "report/blocks.h"

namespace patrol::app {

/// Plots over time: events, position and heading error of the estimate with its own bounds, the errors of odometry and
/// UWB ranges alone, and the localization confidence. Empty if the run ended before the first estimate.
std::vector<report::Block> error_blocks(const RunContents& run);

}  // namespace patrol::app
