#include "slam/surface_points.h"

#include <cmath>
#include <map>
#include <utility>

namespace patrol::slam {

std::vector<Eigen::Vector2d> surface_points(const GridMap& map) {
  std::map<std::pair<int, int>, std::pair<Eigen::Vector2d, double>> squares;  // [row, col]
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    tile.for_each_surface([&](int col, int row, const GridTile::Hits& hits) {
      if (hits.count < 2) return;
      const Cell at{first.col + col, first.row + row};
      auto& [sum, weight] = squares.try_emplace({at.row >> 1, at.col >> 1}, Eigen::Vector2d::Zero(), 0.0).first->second;
      sum += hits.count * (map.center_of(at) + Eigen::Vector2d(hits.mean_x_m, hits.mean_y_m));
      weight += hits.count;
    });
  });
  std::vector<Eigen::Vector2d> points;
  points.reserve(squares.size());
  for (const auto& [square, sum] : squares) points.emplace_back(sum.first / sum.second);
  return points;
}

std::vector<Eigen::Vector2d> estimate_free_space_normals(const std::vector<Eigen::Vector2d>& points, const GridMap& map,
                                                         double radius_m) {
  constexpr double kMinOneSidedness = 0.3;  // 0.64 for a half disc
  const int reach = static_cast<int>(std::ceil(radius_m / map.resolution_m()));
  std::vector<Eigen::Vector2d> free_space_normals;
  free_space_normals.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Cell at = map.cell_at(p);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int free = 0;
    for (int row = at.row - reach; row <= at.row + reach; ++row) {
      for (int col = at.col - reach; col <= at.col + reach; ++col) {
        const std::optional<GridCell> cell = map.find({col, row});
        const Eigen::Vector2d towards = map.center_of({col, row}) - p;
        const double distance_m = towards.norm();
        if (!cell || !cell->is_observed() || cell->is_surface() || distance_m > radius_m || distance_m == 0.0) continue;
        sum += towards / distance_m;
        ++free;
      }
    }
    const double one_sided = free > 0 ? sum.norm() / free : 0.0;
    free_space_normals.push_back(one_sided < kMinOneSidedness ? Eigen::Vector2d(0.0, 0.0)
                                                              : Eigen::Vector2d(sum.normalized()));
  }
  return free_space_normals;
}

}  // namespace patrol::slam
