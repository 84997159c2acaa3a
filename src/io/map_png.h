#pragma once

#include <string>

#include "core/grid.h"

namespace patrol::io {

/// A map as a grey PNG of one pixel per cell, north up: occupied 0, free 254, unknown 205, as map_server has them. Throws
/// std::runtime_error when it is too large for one.
std::string map_png(const OccupancyGrid& map);

}  // namespace patrol::io
