#include "localize/amcl/distance_to_occupied.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {
namespace {

/// Returns whether a neighbor of this occupied cell is free or unknown; only then can the cell be nearest to another
/// cell.
bool is_on_edge(const OccupancyGrid& map, Cell cell) {
  const auto is_solid = [&](int col, int row) { return map.contains({col, row}) && is_occupied(map.at({col, row})); };
  return !is_solid(cell.col - 1, cell.row) || !is_solid(cell.col + 1, cell.row) || !is_solid(cell.col, cell.row - 1) ||
         !is_solid(cell.col, cell.row + 1);
}

void stamp(Grid<float>& squared, Cell center, int reach) {
  const GridGeometry& geometry = squared.geometry();
  const int col_begin = std::max(0, center.col - reach), col_end = std::min(geometry.width, center.col + reach + 1);
  const int row_begin = std::max(0, center.row - reach), row_end = std::min(geometry.height, center.row + reach + 1);
  for (int row = row_begin; row < row_end; ++row) {
    const auto across = static_cast<float>((row - center.row) * (row - center.row));
    float* const line = &squared.at({0, row});
    for (int col = col_begin; col < col_end; ++col) {
      const auto along = static_cast<float>((col - center.col) * (col - center.col));
      line[col] = std::min(line[col], along + across);
    }
  }
}

}  // namespace

Grid<float> distance_to_occupied(const OccupancyGrid& map, double cap_m) {
  const GridGeometry& geometry = map.geometry();
  const double cap_cells = cap_m / geometry.resolution_m;
  Grid<float> distance(geometry, static_cast<float>(cap_cells * cap_cells));
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      if (!is_occupied(map.at({col, row}))) continue;
      distance.at({col, row}) = 0.0F;
      if (is_on_edge(map, {col, row})) stamp(distance, {col, row}, static_cast<int>(cap_cells));
    }
  }
  const auto resolution_m = static_cast<float>(geometry.resolution_m);
  for (float& value : distance.values()) value = resolution_m * std::sqrt(value);
  return distance;
}

}  // namespace patrol::localize
