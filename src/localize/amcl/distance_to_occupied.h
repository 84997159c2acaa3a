#pragma once

#include "core/grid.h"

namespace patrol::localize {

/// Distance of every cell's center to the nearest occupied cell's center (core/geometry/distance_transform.h), m, at
/// most `cap_m`.
Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m);

}  // namespace patrol::localize
