#include "slam/graph/likelihood_pyramid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::slam {
namespace {

constexpr int kReach = 2;  ///< cells around a surface that still count

/// By the squared distance in cells from a surface.
int near_surface(int squared_distance) { return static_cast<int>(std::lround(LikelihoodPyramid::kOnSurface * std::exp(-0.5 * squared_distance))); }

}  // namespace

LikelihoodPyramid::LikelihoodPyramid(const GridMap& map, double resolution_m, int num_levels) : resolution_m_(resolution_m) {
  levels_.push_back(draw_finest(map));
  for (int l = 1; l < num_levels; ++l) levels_.push_back(halved(levels_.back(), l == 1));
}

Cell LikelihoodPyramid::cell_of(const Eigen::Vector2d& p_map) const {
  return {static_cast<int>(std::floor(p_map.x() / resolution_m_)), static_cast<int>(std::floor(p_map.y() / resolution_m_))};
}

// Zeros over all tiles, widened by `kReach`. Means of hits lie up to half a map cell from the centers, and slightly more after
// rounding to float: an extent of the centers alone would not hold the cells of means at the tiles' edges.
LikelihoodPyramid::Level LikelihoodPyramid::extent_of(const GridMap& map) const {
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
    level.first_col = low_col - kReach, level.first_row = low_row - kReach;
    level.width = high_col - low_col + 1 + 2 * kReach, level.height = high_row - low_row + 1 + 2 * kReach;
  }
  level.clear();
  return level;
}

LikelihoodPyramid::Level LikelihoodPyramid::draw_finest(const GridMap& map) const {
  Level finest = extent_of(map);
  std::vector<Cell> surfaces;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell& cell = tile.at(col, row);
        if (!cell.is_known()) continue;
        const Eigen::Vector2d center = map.center_of({first.col + col, first.row + row});
        if (cell.is_surface()) {
          surfaces.push_back(cell_of(center + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m)));
        } else if (const Cell coarse = cell_of(center); finest.at(coarse.col, coarse.row) == 0) {
          finest.at(coarse.col, coarse.row) = kInFreeSpace;
        }
      }
    }
  });
  for (const Cell& surface : surfaces) {
    for (int row = -kReach; row <= kReach; ++row) {
      for (int col = -kReach; col <= kReach; ++col) {
        std::int8_t& value = finest.at(surface.col + col, surface.row + row);
        value = std::max(value, static_cast<std::int8_t>(near_surface(col * col + row * row)));
      }
    }
  }
  return finest;
}

// A cell and its neighbours are four by four of the level below, of whose cells each but the finest's speaks for two by two.
LikelihoodPyramid::Level LikelihoodPyramid::halved(const Level& fine, bool is_of_finest) {
  Level coarse;
  coarse.first_col = (fine.first_col >> 1) - 1, coarse.first_row = (fine.first_row >> 1) - 1;
  coarse.width = ((fine.first_col + fine.width) >> 1) + 1 - coarse.first_col, coarse.height = ((fine.first_row + fine.height) >> 1) + 1 - coarse.first_row;
  coarse.clear();
  const int step = is_of_finest ? 1 : 2;
  for (int row = coarse.first_row; row < coarse.first_row + coarse.height; ++row) {
    for (int col = coarse.first_col; col < coarse.first_col + coarse.width; ++col) {
      int highest = std::numeric_limits<std::int8_t>::min();
      for (int j = 0; j < 4; j += step) {
        for (int i = 0; i < 4; i += step) highest = std::max(highest, fine.find(2 * col + i, 2 * row + j));
      }
      coarse.at(col, row) = static_cast<std::int8_t>(highest);
    }
  }
  return coarse;
}

}  // namespace patrol::slam
