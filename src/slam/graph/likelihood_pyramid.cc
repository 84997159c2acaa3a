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
  const auto cell_of = [&](const Eigen::Vector2d& p) {
    return Cell{static_cast<int>(std::floor(p.x() / resolution_m)), static_cast<int>(std::floor(p.y() / resolution_m))};
  };
  Level finest;
  constexpr int kMax = std::numeric_limits<int>::max();
  int low_col = kMax, low_row = kMax, high_col = -kMax, high_row = -kMax;
  map.for_each_tile([&](Cell first, const GridTile&) {
    const Cell low = cell_of(map.center_of(first)), high = cell_of(map.center_of({first.col + GridTile::kSize - 1, first.row + GridTile::kSize - 1}));
    low_col = std::min(low_col, low.col), low_row = std::min(low_row, low.row);
    high_col = std::max(high_col, high.col), high_row = std::max(high_row, high.row);
  });
  if (low_col <= high_col) {
    finest.first_col = low_col - kReach, finest.first_row = low_row - kReach;
    finest.width = high_col - low_col + 1 + 2 * kReach, finest.height = high_row - low_row + 1 + 2 * kReach;
  }
  finest.values.assign(static_cast<std::size_t>(finest.width) * static_cast<std::size_t>(finest.height), 0);
  const auto at = [&](Level& level, int col, int row) -> std::int8_t& {
    return level.values[static_cast<std::size_t>((row - level.first_row) * level.width + col - level.first_col)];
  };
  std::vector<Cell> surfaces;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell& cell = tile.at(col, row);
        if (!cell.is_known()) continue;
        const Eigen::Vector2d center = map.center_of({first.col + col, first.row + row});
        if (cell.is_surface()) {
          surfaces.push_back(cell_of(center + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m)));
        } else if (const Cell coarse = cell_of(center); at(finest, coarse.col, coarse.row) == 0) {
          at(finest, coarse.col, coarse.row) = kInFreeSpace;
        }
      }
    }
  });
  for (const Cell& surface : surfaces) {
    for (int row = -kReach; row <= kReach; ++row) {
      for (int col = -kReach; col <= kReach; ++col) {
        std::int8_t& value = at(finest, surface.col + col, surface.row + row);
        value = std::max(value, static_cast<std::int8_t>(near_surface(col * col + row * row)));
      }
    }
  }
  levels_.push_back(std::move(finest));
  for (int l = 1; l < num_levels; ++l) {
    const Level& fine = levels_.back();
    const auto fine_at = [&](int col, int row) -> int {
      const int c = col - fine.first_col, r = row - fine.first_row;
      return c < 0 || r < 0 || c >= fine.width || r >= fine.height ? 0 : fine.values[static_cast<std::size_t>(r * fine.width + c)];
    };
    Level coarse;
    coarse.first_col = (fine.first_col >> 1) - 1, coarse.first_row = (fine.first_row >> 1) - 1;
    coarse.width = ((fine.first_col + fine.width) >> 1) + 1 - coarse.first_col, coarse.height = ((fine.first_row + fine.height) >> 1) + 1 - coarse.first_row;
    coarse.values.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
    for (int row = 0; row < coarse.height; ++row) {
      for (int col = 0; col < coarse.width; ++col) {
        // Itself and its neighbours are four by four of the level below, of whose cells each but the finest's speaks for two by two.
        const int c = 2 * (coarse.first_col + col), r = 2 * (coarse.first_row + row), step = l == 1 ? 1 : 2;
        int highest = std::numeric_limits<std::int8_t>::min();
        for (int j = 0; j < 4; j += step) {
          for (int i = 0; i < 4; i += step) highest = std::max(highest, fine_at(c + i, r + j));
        }
        coarse.values[static_cast<std::size_t>(row * coarse.width + col)] = static_cast<std::int8_t>(highest);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

}  // namespace patrol::slam
