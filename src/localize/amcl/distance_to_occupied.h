#pragma once

#include <cstdint>

#include "core/grid.h"

namespace patrol::localize {

/// Occupancy thresholds of ROS map_server.
inline bool is_occupied(std::int8_t percent) { return percent >= 65; }
inline bool is_free(std::int8_t percent) { return percent >= 0 && percent < 25; }

/// Distance of every cell's center to the nearest occupied cell's center (core/geometry/distance_transform.h), m, at
/// most `cap_m`.
Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m);

}  // namespace patrol::localize
