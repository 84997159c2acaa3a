#pragma once

#include <string>

#include "core/grid.h"

namespace patrol::io {

/// Renders a map as a gray PNG of one pixel per cell, north up: occupied 0, free 254, unknown 205, as in map_server.
/// Throws std::runtime_error if the map is too large for a PNG.
std::string map_png(const OccupancyGrid& map);

}  // namespace patrol::io
