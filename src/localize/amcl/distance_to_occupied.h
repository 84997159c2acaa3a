#pragma once

#include <cstdint>

#include "core/grid.h"

namespace patrol::localize {

/// Occupancy thresholds of ROS map_server.
inline bool is_occupied(std::int8_t percent) { return percent >= 65; }
inline bool is_free(std::int8_t percent) { return percent >= 0 && percent < 25; }

/// Distance from the center of every cell to the center of the nearest occupied cell, m, at most `cap_m`.
///
/// Exact: every occupied cell on the edge of a wall updates the surrounding square of cells. Maps with walls one cell
/// thick have few occupied cells, so that a transform by rows and columns would not be faster.
Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m);

}  // namespace patrol::localize
