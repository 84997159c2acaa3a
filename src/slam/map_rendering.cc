#include "slam/map_rendering.h"

#include <algorithm>
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
    const int last_col = first.col + GridTile::kSize - 1, last_row = first.row + GridTile::kSize - 1;
    if (first.col >= col_min && last_col <= col_max && first.row >= row_min && last_row <= row_max) return;
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
      const std::uint16_t* passes = &tile.passes[GridTile::index_of(0, row)];
      for (int col = 0; col < GridTile::kSize; ++col) {
        if (passes[col] > 0) grid.at(to_grid({first.col + col, first.row + row})) = kFree;
      }
    }
  });
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    tile.for_each_surface([&](int col, int row, const GridTile::Hits& hits) {
      const int passes = tile.passes[GridTile::index_of(col, row)];
      if (hits.count < min_hits || hits.count < min_hit_ratio * (hits.count + passes)) return;
      const Eigen::Vector2d mean =
          map.center_of({first.col + col, first.row + row}) + Eigen::Vector2d(hits.mean_x_m, hits.mean_y_m);
      const Cell at = to_grid(map.cell_at(surface_point(map, mean)));
      if (grid.contains(at)) grid.at(at) = kOccupied;
    });
  });
  return grid;
}

}  // namespace patrol::slam
