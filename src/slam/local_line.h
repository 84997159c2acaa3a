#pragma once

#include <optional>

#include <Eigen/Core>

#include "slam/grid_map.h"

namespace patrol::slam {

/// Local surface around a point: a line through the mean hits of the cells nearby.
struct LocalLine {
  Eigen::Vector2d point_map;   ///< weighted mean of the mean hits of the cells
  Eigen::Vector2d normal_map;  ///< unit normal, on either side
  double normal_var_m2;        ///< variance across the line
  double linearity;            ///< linearity: 1 for a straight wall; 0 if as wide as long (corner, bush)
  int num_hits;                ///< number of hits in the fit

  double distance_m(const Eigen::Vector2d& p_map) const { return normal_map.dot(p_map - point_map); }
};

/// Fits a line by the principal axes of the mean hits of the surface cells around p, weighted by their hits. The
/// neighborhood extends `radius_cells` columns and rows from p's cell. The weights place a wall on the border of two
/// cells at the mean of its hits, not between the cells. Returns none if there are fewer than three cells or if their
/// extent is too small.
std::optional<LocalLine> fit_local_line(const GridMap& map, const Eigen::Vector2d& p_map, int radius_cells);

}  // namespace patrol::slam
