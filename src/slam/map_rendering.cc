#include "slam/map_rendering.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "slam/local_line.h"

namespace patrol::slam {
namespace {

constexpr int kThinningRadius = 2;     // cells
constexpr double kMinLinearity = 0.6;  // below it, hits are rendered without projection

/// Projects the mean hit of a cell onto the local line, if the surface is linear.
Eigen::Vector2d surface_point(const GridMap& map, const Eigen::Vector2d& mean) {
  const std::optional<LocalLine> line = fit_local_line(map, mean, kThinningRadius);
  if (!line || line->linearity < kMinLinearity) return mean;
  return mean - line->distance_m(mean) * line->normal_map;
}

/// Smallest rectangle of cells that contains all observed cells.
GridGeometry observed_extent(const GridMap& map) {
  constexpr int kFar = std::numeric_limits<int>::max();
  int col_min = kFar, row_min = kFar, col_max = -kFar, row_max = -kFar;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        if (!tile.at(col, row).is_observed()) continue;
        col_min = std::min(col_min, first.col + col), col_max = std::max(col_max, first.col + col);
        row_min = std::min(row_min, first.row + row), row_max = std::max(row_max, first.row + row);
      }
    }
  });
  if (col_min > col_max) return {.resolution_m = map.resolution_m()};
  return {.resolution_m = map.resolution_m(),
          .width = col_max - col_min + 1,
          .height = row_max - row_min + 1,
          .origin_m = map.resolution_m() * Eigen::Vector2d(col_min, row_min)};
}

}  // namespace

OccupancyGrid render_map(const GridMap& map, int min_hits, double min_hit_ratio) {
  OccupancyGrid grid(observed_extent(map), kUnknown);
  const Cell corner = map.cell_at(grid.geometry().origin_m + Eigen::Vector2d::Constant(0.5 * map.resolution_m()));
  const auto to_grid = [&](Cell cell) { return Cell{cell.col - corner.col, cell.row - corner.row}; };

  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        if (tile.at(col, row).passes > 0) grid.at(to_grid({first.col + col, first.row + row})) = kFree;
      }
    }
  });
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (std::uint32_t bits = tile.surface_bits[static_cast<std::size_t>(row)]; bits != 0; bits &= bits - 1) {
        const int col = std::countr_zero(bits);
        const GridCell& cell = tile.at(col, row);
        if (cell.hits < min_hits || cell.hits < min_hit_ratio * (cell.hits + cell.passes)) continue;
        const Eigen::Vector2d mean =
            map.center_of({first.col + col, first.row + row}) + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m);
        const Cell at = to_grid(map.cell_at(surface_point(map, mean)));
        if (grid.contains(at)) grid.at(at) = kOccupied;
      }
    }
  });
  return grid;
}

}  // namespace patrol::slam
