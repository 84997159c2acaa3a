#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/grid_map.h"

namespace patrol::slam {

/// Mean hits of the surfaces of the map, one for each square of two by two cells, in row order. Cells with a single hit
/// are excluded.
std::vector<Eigen::Vector2d> surface_points(const GridMap& map);

/// Free-space normals, [point]: unit vectors in map toward the free cells within `radius_m`. Zero for points observed
/// from all sides, for example thin posts. The normals distinguish the two sides of a thin wall, which are close
/// together but have opposite normals.
std::vector<Eigen::Vector2d> estimate_free_space_normals(const std::vector<Eigen::Vector2d>& points, const GridMap& map,
                                                         double radius_m);

}  // namespace patrol::slam
