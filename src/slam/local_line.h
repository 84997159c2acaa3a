#pragma once

#include <Eigen/Core>

#include <optional>

#include "slam/grid_map.h"

namespace patrol::slam {

/// The piece of surface around a point: a line through the mean hits of the cells near it.
struct LocalLine {
  Eigen::Vector2d point_map;   ///< weighted mean of the cells' means
  Eigen::Vector2d normal_map;  ///< unit; either side
  double roughness_var_m2;     ///< scatter across the line
  double straightness;         ///< 1: a straight wall; 0: as wide as long (a corner, a bush)
  int num_hits;                ///< behind it

  double distance_m(const Eigen::Vector2d& p_map) const { return normal_map.dot(p_map - point_map); }
};

/// Principal axes of the cells' means at most `radius_cells` columns and rows from p's cell, each weighted by its hits: a
/// wall on the border of two cells lies where the shares of its hits say, not between the cells. None if fewer than
/// three cells, or all in one place, are there.
std::optional<LocalLine> fit_local_line(const GridMap& map, const Eigen::Vector2d& p_map, int radius_cells);

}  // namespace patrol::slam
