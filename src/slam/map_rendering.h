#pragma once

#include "core/grid.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Renders the map as an occupancy grid (unknown, free, occupied), cropped to the observed cells.
///
/// Noise spreads the hits of a wall over two or three cells across it. The mean hit of each surface cell is therefore
/// projected onto the local line, and only the cell that contains the projection is occupied. Walls are thus one cell
/// thick and located at the average of all hits. Cells with fewer than `min_hits` hits are outliers. Cells where the
/// ratio of hits to all beams is below `min_hit_ratio` were occupied by moving objects.
OccupancyGrid render_map(const GridMap& map, int min_hits, double min_hit_ratio = 0.0);

}  // namespace patrol::slam
