#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid.h"

namespace patrol::plan {

/// Interpolates bilinearly between cell centers; `value_at` takes a cell inside the grid. Outside the grid, the values
/// of the border continue.
template <typename ValueAt>
double interpolate_bilinear(const GridGeometry& grid, const Eigen::Vector2d& p, const ValueAt& value_at) {
  const double col = (p.x() - grid.origin_m.x()) / grid.resolution_m - 0.5;
  const double row = (p.y() - grid.origin_m.y()) / grid.resolution_m - 0.5;
  const double col_floor = std::floor(col), row_floor = std::floor(row);
  const double u = col - col_floor, v = row - row_floor;
  const int left = std::clamp(static_cast<int>(col_floor), 0, grid.width - 1);
  const int low = std::clamp(static_cast<int>(row_floor), 0, grid.height - 1);
  const int right = std::min(left + 1, grid.width - 1), high = std::min(low + 1, grid.height - 1);
  return (1.0 - v) * ((1.0 - u) * value_at(Cell{left, low}) + u * value_at(Cell{right, low})) +
         v * ((1.0 - u) * value_at(Cell{left, high}) + u * value_at(Cell{right, high}));
}

}  // namespace patrol::plan
