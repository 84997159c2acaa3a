#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "report/blocks.h"

namespace patrol::app {

/// Map built by the run over the reference map, colored by its errors, with both paths and the positions of events.
/// Empty without a map.
std::vector<report::Block> map_blocks(const RunContents& run);

}  // namespace patrol::app
