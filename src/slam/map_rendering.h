#pragma once

#include "core/grid.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// The map as others see it: unknown, free or occupied, cut to what is known.
///
/// Noise spreads the hits of a wall over two or three cells across it. Each surface cell's mean is therefore moved onto the
/// line of its neighbourhood, and only the cell it then lies in is occupied: walls are one cell thick and lie where
/// the average of all hits lies. Cells with fewer than `min_hits` are stray, and those where
/// fewer than `min_hit_share` of all beams ended are what has moved on.
OccupancyGrid render_map(const GridMap& map, int min_hits, double min_hit_share = 0.0);

}  // namespace patrol::slam
