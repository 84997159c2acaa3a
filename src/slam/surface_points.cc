#include "slam/surface_points.h"

#include <map>
#include <utility>

namespace patrol::slam {

std::vector<Eigen::Vector2d> surface_points(const GridMap& map) {
  std::map<std::pair<int, int>, std::pair<Eigen::Vector2d, double>> squares;  // [row, col]
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell& cell = tile.at(col, row);
        if (!cell.is_surface() || cell.hits < 2) continue;
        const Cell at{first.col + col, first.row + row};
        auto& [sum, weight] = squares.try_emplace({at.row >> 1, at.col >> 1}, Eigen::Vector2d::Zero(), 0.0).first->second;
        sum += cell.hits * (map.center_of(at) + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m));
        weight += cell.hits;
      }
    }
  });
  std::vector<Eigen::Vector2d> points;
  points.reserve(squares.size());
  for (const auto& [square, sum] : squares) points.push_back(sum.first / sum.second);
  return points;
}

}  // namespace patrol::slam
