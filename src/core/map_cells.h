#pragma once

#include <cstdint>

/// Classes of the cells of an OccupancyGrid (core/grid.h), with the default thresholds of ROS 2 map_server.
namespace patrol {

/// Returns whether a cell is occupied. `percent`: occupancy, -1 unknown.
inline bool is_occupied(std::int8_t percent) { return percent >= 65; }

/// Returns whether a cell is known to be free. `percent`: occupancy, -1 unknown.
inline bool is_free(std::int8_t percent) { return percent >= 0 && percent < 25; }

}  // namespace patrol
