#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"

namespace patrol::localize {

/// Local line of a surface of the map.
struct SurfaceLine {
  Eigen::Vector2d point_map;
  Eigen::Vector2d normal_map;  ///< unit normal, on either side
  double normal_var_m2;        ///< variance of the cells across the line
  double linearity;            ///< linearity: 1 for a straight wall ... 0 if as wide as long
};

/// Precomputed local lines of a static map: for every cell near a surface, the line through the surrounding occupied
/// cells (slam/local_line.h). Scans are matched about twenty times per second for hours. The lines of a tunnel of 150 m
/// take 0.1 s and a few megabytes.
class LineField {
 public:
  /// Lines are fitted to the occupied cells within `radius_cells` columns and rows.
  LineField(const OccupancyGrid& map, int radius_cells);

  /// Returns null if no surface is nearby.
  const SurfaceLine* find(const Eigen::Vector2d& p_map) const;
  /// Maximum distance of a point from a surface whose line is found, m.
  double max_distance_m() const { return max_distance_m_; }

 private:
  static constexpr std::int32_t kNone = -1;

  double max_distance_m_;
  Grid<std::int32_t> index_;  ///< index of each cell's line in lines_
  std::vector<SurfaceLine> lines_;
};

}  // namespace patrol::localize
