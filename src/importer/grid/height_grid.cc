#include "importer/grid/height_grid.h"

#include <algorithm>
#include <vector>

namespace patrol::importer {

double interpolated(const Grid<float>& height_m, const Eigen::Vector2d& p_m) {
  const GridGeometry& grid = height_m.geometry();
  const Eigen::Array2d position = (p_m - grid.origin_m).array() / grid.resolution_m - 0.5;
  const Eigen::Array2d limited = position.max(0.0).min(Eigen::Array2d(grid.width - 1 - 1e-9, grid.height - 1 - 1e-9));
  const int col = static_cast<int>(limited.x()), row = static_cast<int>(limited.y());
  const double u = limited.x() - col, v = limited.y() - row;
  const auto z = [&](int c, int r) {
    return double{height_m.at({std::min(c, grid.width - 1), std::min(r, grid.height - 1)})};
  };
  return (1.0 - v) * ((1.0 - u) * z(col, row) + u * z(col + 1, row)) +
         v * ((1.0 - u) * z(col, row + 1) + u * z(col + 1, row + 1));
}

void fill_smoothly(Grid<float>& values, const Grid<char>& is_known) {
  const GridGeometry& grid = values.geometry();
  if (grid.width <= 1 && grid.height <= 1) return;
  // Means of 2 x 2 cells, recursively, are the values of the unknown cells before smoothing.
  GridGeometry half = grid;
  half.resolution_m *= 2.0;
  half.width = (grid.width + 1) / 2;
  half.height = (grid.height + 1) / 2;
  Grid<float> coarse(half, 0.0f);
  Grid<char> is_coarse_known(half, 0);
  bool has_unknown = false;
  for (int row = 0; row < half.height; ++row) {
    for (int col = 0; col < half.width; ++col) {
      float sum = 0.0f;
      int count = 0;
      for (const Cell cell : {Cell{2 * col, 2 * row}, Cell{2 * col + 1, 2 * row}, Cell{2 * col, 2 * row + 1},
                              Cell{2 * col + 1, 2 * row + 1}}) {
        if (!grid.contains(cell)) continue;
        if (is_known.at(cell) == 0) {
          has_unknown = true;
          continue;
        }
        sum += values.at(cell);
        ++count;
      }
      if (count == 0) continue;
      coarse.at({col, row}) = sum / static_cast<float>(count);
      is_coarse_known.at({col, row}) = 1;
    }
  }
  if (!has_unknown) return;
  fill_smoothly(coarse, is_coarse_known);
  std::vector<Cell> unknown;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (is_known.at({col, row}) != 0) continue;
      values.at({col, row}) = coarse.at({col / 2, row / 2});
      unknown.push_back({col, row});
    }
  }
  constexpr int kSweeps = 12;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Cell& cell : unknown) {
      float sum = 0.0f;
      int count = 0;
      for (const Cell next : {Cell{cell.col + 1, cell.row}, Cell{cell.col - 1, cell.row}, Cell{cell.col, cell.row + 1},
                              Cell{cell.col, cell.row - 1}}) {
        if (!grid.contains(next)) continue;
        sum += values.at(next);
        ++count;
      }
      values.at(cell) = sum / static_cast<float>(count);
    }
  }
}

}  // namespace patrol::importer
