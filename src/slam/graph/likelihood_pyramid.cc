#include "slam/graph/likelihood_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace patrol::slam {
namespace {

constexpr int kMargin_cells = 2;  ///< radius in cells around a surface with nonzero likelihood

/// Values around a surface, [row][col].
using Kernel = std::array<std::array<std::int8_t, 2 * kMargin_cells + 1>, 2 * kMargin_cells + 1>;

Kernel surface_kernel() {
  Kernel kernel{};
  for (int row = -kMargin_cells; row <= kMargin_cells; ++row) {
    for (int col = -kMargin_cells; col <= kMargin_cells; ++col) {
      const double likelihood = std::exp(-0.5 * (col * col + row * row));
      kernel[static_cast<std::size_t>(row + kMargin_cells)][static_cast<std::size_t>(col + kMargin_cells)] =
          static_cast<std::int8_t>(std::lround(LikelihoodPyramid::kOnSurface * likelihood));
    }
  }
  return kernel;
}

}  // namespace

LikelihoodPyramid::LikelihoodPyramid(const GridMap& map, double resolution_m, int num_levels)
    : resolution_m_(resolution_m) {
  levels_.push_back(rasterize_finest(map));
  for (int l = 1; l < num_levels; ++l) levels_.push_back(halved(levels_.back(), l == 1));
}

Cell LikelihoodPyramid::cell_of(const Eigen::Vector2d& p_map) const {
  return {static_cast<int>(std::floor(p_map.x() / resolution_m_)),
          static_cast<int>(std::floor(p_map.y() / resolution_m_))};
}

// Returns an empty level that covers all tiles, plus a margin of `kMargin_cells` cells. Mean hits are up to half a map
// cell from the cell centers, and slightly more after rounding to float. The extent of the centers alone would be too
// small.
LikelihoodPyramid::Level LikelihoodPyramid::empty_level(const GridMap& map) const {
  constexpr int kMax = std::numeric_limits<int>::max();
  int low_col = kMax, low_row = kMax, high_col = -kMax, high_row = -kMax;
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(map.resolution_m());
  map.for_each_tile([&](Cell first, const GridTile&) {
    const Cell last{first.col + GridTile::kSize - 1, first.row + GridTile::kSize - 1};
    const Cell low = cell_of(map.center_of(first) - margin), high = cell_of(map.center_of(last) + margin);
    low_col = std::min(low_col, low.col), low_row = std::min(low_row, low.row);
    high_col = std::max(high_col, high.col), high_row = std::max(high_row, high.row);
  });
  Level level;
  if (low_col <= high_col) {
    level.first_col = low_col - kMargin_cells, level.first_row = low_row - kMargin_cells;
    level.width = high_col - low_col + 1 + 2 * kMargin_cells, level.height = high_row - low_row + 1 + 2 * kMargin_cells;
  }
  level.clear();
  return level;
}

LikelihoodPyramid::Level LikelihoodPyramid::rasterize_finest(const GridMap& map) const {
  Level finest = empty_level(map);
  std::vector<Cell> surfaces;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    std::array<Cell, GridTile::kSize> centers;  // of the cells on the tile's diagonal: the column and row of each cell
    for (int i = 0; i < GridTile::kSize; ++i)
      centers[static_cast<std::size_t>(i)] = cell_of(map.center_of({first.col + i, first.row + i}));
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell& cell = tile.at(col, row);
        if (!cell.is_observed()) continue;
        if (cell.is_surface()) {
          const Eigen::Vector2d center = map.center_of({first.col + col, first.row + row});
          surfaces.push_back(cell_of(center + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m)));
        } else if (std::int8_t& value = finest.at(centers[static_cast<std::size_t>(col)].col,
                                                  centers[static_cast<std::size_t>(row)].row);
                   value == 0) {
          value = kInFreeSpace;
        }
      }
    }
  });
  const Kernel kernel = surface_kernel();
  for (const Cell& surface : surfaces) {
    int row = surface.row - kMargin_cells;
    for (const auto& values : kernel) {
      std::int8_t* cell = &finest.at(surface.col - kMargin_cells, row++);
      for (const std::int8_t value : values) {
        *cell = std::max(*cell, value);
        ++cell;
      }
    }
  }
  return finest;
}

// A cell and its neighbors cover 4 x 4 cells of the level below. Above the finest level each of those already covers 2
// x 2, so every second one suffices.
LikelihoodPyramid::Level LikelihoodPyramid::halved(const Level& fine, bool is_from_finest) {
  Level coarse;
  coarse.first_col = (fine.first_col >> 1) - 1, coarse.first_row = (fine.first_row >> 1) - 1;
  coarse.width = ((fine.first_col + fine.width) >> 1) + 1 - coarse.first_col,
  coarse.height = ((fine.first_row + fine.height) >> 1) + 1 - coarse.first_row;
  coarse.clear();
  const int step = is_from_finest ? 1 : 2;
  for (int row = coarse.first_row; row < coarse.first_row + coarse.height; ++row) {
    for (int col = coarse.first_col; col < coarse.first_col + coarse.width; ++col) {
      int highest = std::numeric_limits<int>::min();
      for (int j = 0; j < 4; j += step) {
        for (int i = 0; i < 4; i += step) highest = std::max(highest, fine.find(2 * col + i, 2 * row + j));
      }
      coarse.at(col, row) = static_cast<std::int8_t>(highest);
    }
  }
  return coarse;
}

}  // namespace patrol::slam
