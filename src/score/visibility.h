#pragma once

#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Reference map: the true map and, for each cell, whether a lidar on the given trajectory could have observed it.
struct ReferenceMap {
  OccupancyGrid cells;               ///< in world; unknown inside solid objects
  Grid<std::uint8_t> is_observable;  ///< 1 for observable cells; geometry of `cells`
};

/// Marks the cells that a lidar on the trajectory could have observed. These are the cells that a ray of at most
/// `max_range_m` crosses or ends in before it is blocked, also from poses outside of the map. Poses nearer than
/// `spacing_m` to the previous one are skipped. Occupied cells within one cell of a ray's end are observable too,
/// because a ray is thinner than a lidar beam.
ReferenceMap mark_observable(OccupancyGrid reference, const Trajectory& T_world_body, double max_range_m,
                             double spacing_m = 0.5);

/// Keeps the observable cells and sets all others to unknown, as in a map for map_server.
OccupancyGrid observable_part(const ReferenceMap& reference);

}  // namespace patrol::score
