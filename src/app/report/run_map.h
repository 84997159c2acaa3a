#pragma once

#include <vector>

#include "app/report/run_contents.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// The built map over the true one in the colours of its errors, with both paths, and what the events tell of places. Empty when there
/// is no map.
std::vector<render::Block> map_blocks(const RunContents& run);

}  // namespace patrol::app
