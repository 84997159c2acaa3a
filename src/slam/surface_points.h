#pragma once

#include <Eigen/Core>

#include <vector>

#include "slam/grid_map.h"

namespace patrol::slam {

/// The mean of the hits on the map's surfaces, one for each square of two by two cells; row by row. Cells with a single hit are left out.
std::vector<Eigen::Vector2d> surface_points(const GridMap& map);

/// [point]: from which side it was seen, as a unit vector in map towards what is known to be free within `radius_m`; zero for what was seen from all around,
/// as a thin post. A wall's two faces lie near enough to be taken for each other, but never face the same way.
std::vector<Eigen::Vector2d> facings_of(const std::vector<Eigen::Vector2d>& points, const GridMap& map, double radius_m);

}  // namespace patrol::slam
