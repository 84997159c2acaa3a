#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// Events, position and heading error of the estimate with the bounds that it gives itself, what odometry and UWB ranges alone would
/// have believed, and the localisation's trust: all over time. Empty when the run ended before there was an estimate.
std::vector<render::Block> error_blocks(const RunContents& run);

}  // namespace patrol::app
