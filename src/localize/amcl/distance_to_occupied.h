#pragma once

#include <cstdint>

#include "core/grid.h"

namespace patrol::localize {

/// As map_server reads its thresholds.
inline bool is_occupied(std::int8_t percent) { return percent >= 65; }
inline bool is_free(std::int8_t percent) { return percent >= 0 && percent < 25; }

/// Distance of every cell's centre to the nearest occupied cell's centre, m, and `cap_m` where none is nearer than that.
///
/// Exact: every occupied cell on the edge of a wall stamps the square of cells round it. A map of walls one cell thick has
/// few of them, so that a transform of lines and columns would be no quicker.
Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m);

}  // namespace patrol::localize
