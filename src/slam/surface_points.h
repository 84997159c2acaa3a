#pragma once

#include <Eigen/Core>

#include <vector>

#include "slam/grid_map.h"

namespace patrol::slam {

/// The mean of the hits on the map's surfaces, one for each square of two by two cells; row by row. Cells with a single hit are left out.
std::vector<Eigen::Vector2d> surface_points(const GridMap& map);

}  // namespace patrol::slam
