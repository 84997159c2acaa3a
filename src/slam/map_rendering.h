#pragma once

#include "core/grid.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// The map as others see it: unknown, free or occupied, cut to what is known.
///
/// Noise spreads the hits of a wall over two or three cells across it. Each surface cell's mean is therefore moved onto the
/// line of its neighbourhood, and only the cell it then lies in is occupied: walls are one cell thick and lie where
/// the average of all hits lies. Cells with fewer than `min_hits` are stray.
OccupancyGrid render_map(const GridMap& map, int min_hits);

}  // namespace patrol::slam
