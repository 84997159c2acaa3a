#pragma once

#include <cstdint>

namespace patrol::importer {

/// Returns whether a cell of a floor plan is a wall, with the threshold of map_server. `percent`: as in OccupancyGrid.
inline bool is_wall(std::int8_t percent) { return percent >= 65; }

/// Returns whether a cell of a floor plan is known to be free, with the threshold of map_server.
inline bool is_free(std::int8_t percent) { return percent >= 0 && percent < 20; }

}  // namespace patrol::importer
