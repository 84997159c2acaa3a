#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/grid.h"

namespace patrol::importer {

/// Returns the range of x of a triangle on the line y; the lower end is above the upper one if it misses the line.
std::pair<double, double> range_on_line(const std::array<Eigen::Vector3d, 3>& corners, double y);

/// Calls `visit(cell, z)` for each cell of the grid whose center is inside of the triangle seen from above or on its
/// edge, with the height of the triangle there. Vertical triangles have none.
template <typename Visit>
void visit_cell_centers(const std::array<Eigen::Vector3d, 3>& corners, const GridGeometry& grid, Visit visit) {
  const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  if (std::abs(normal.z()) <= 1e-9 * normal.norm()) return;
  const auto cell_range = [&](int axis, int count) {
    double lower = corners[0][axis], upper = lower;
    for (const Eigen::Vector3d& corner : corners)
      lower = std::min(lower, corner[axis]), upper = std::max(upper, corner[axis]);
    const double first = std::ceil((lower - grid.origin_m[axis]) / grid.resolution_m - 0.5 - 1e-9);
    const double last = std::floor((upper - grid.origin_m[axis]) / grid.resolution_m - 0.5 + 1e-9);
    return std::pair(static_cast<int>(std::max(0.0, first)), static_cast<int>(std::min(count - 1.0, last)));
  };
  const auto [first_col, last_col] = cell_range(0, grid.width);
  const auto [first_row, last_row] = cell_range(1, grid.height);
  const double sign = normal.z() > 0.0 ? 1.0 : -1.0;
  for (int row = first_row; row <= last_row; ++row) {
    const auto [left, right] = range_on_line(corners, grid.center_of({0, row}).y());
    if (left > right) continue;
    const int begin_col = std::max(first_col, grid.cell_at({left - 1e-6, 0.0}).col);
    const int end_col = std::min(last_col, grid.cell_at({right + 1e-6, 0.0}).col);
    for (int col = begin_col; col <= end_col; ++col) {
      const Eigen::Vector2d center = grid.center_of({col, row});
      bool is_inside = true;
      for (std::size_t k = 0; k < 3 && is_inside; ++k) {
        const Eigen::Vector2d edge = (corners[(k + 1) % 3] - corners[k]).template head<2>(),
                              to = center - corners[k].template head<2>();
        is_inside = sign * (edge.x() * to.y() - edge.y() * to.x()) >= -1e-9 * edge.norm();
      }
      if (!is_inside) continue;
      visit(Cell{col, row},
            corners[0].z() - (normal.template head<2>().dot(center - corners[0].template head<2>())) / normal.z());
    }
  }
}

}  // namespace patrol::importer
