#pragma once

#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/trajectory.h"

namespace patrol::score {

/// What there was to map: the true map and, for each cell, whether this trajectory could have seen it.
struct ReferenceMap {
  OccupancyGrid cells;              ///< in world; unknown inside solid things
  Grid<std::uint8_t> is_seeable;    ///< same geometry
};

/// Marks the cells that a lidar at these places could have seen: those a ray of at most `max_range_m` crosses or ends in
/// before anything else stops it. Places nearer than `spacing_m` to the one before are left out. Occupied cells within
/// one cell of where a ray ends are seeable too: rays are thinner than what they measure.
ReferenceMap mark_seeable(OccupancyGrid reference, const Trajectory& T_world_body, double max_range_m,
                          double spacing_m = 0.5);

/// Seeable cells as they are, the others unknown: the true map as map_server's files can hold it.
OccupancyGrid seeable_part(const ReferenceMap& reference);

}  // namespace patrol::score
