#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "core/grid.h"

namespace patrol::localize {

/// A short piece of a surface of the map.
struct SurfaceLine {
  Eigen::Vector2d point_map;
  Eigen::Vector2d normal_map;  ///< unit, either side
  double roughness_var_m2;     ///< scatter of the cells across the line
  double straightness;         ///< 1 a straight wall ... 0 as wide as long
};

/// For every place near a surface of a map that does not change, the line through the occupied cells round it
/// (slam/local_line.h), fitted once. A scan is laid on the map some twenty times a second for hours; the lines of a
/// tunnel of 150 m take a tenth of a second and a few megabytes.
class LineField {
 public:
  /// Lines reach `radius_cells` columns and rows from where they are asked for.
  LineField(const OccupancyGrid& map, int radius_cells);

  /// Null where no surface is near.
  const SurfaceLine* find(const Eigen::Vector2d& p_map) const;
  /// How far off a surface a point may lie and still find its line, m.
  double reach_m() const { return reach_m_; }

 private:
  static constexpr std::int32_t kNone = -1;

  double reach_m_;
  Grid<std::int32_t> index_;  ///< of each cell's line
  std::vector<SurfaceLine> lines_;
};

}  // namespace patrol::localize
