#include "slam/graph/submap.h"

#include <cmath>
#include <map>
#include <utility>

namespace patrol::slam {
namespace {

constexpr double kPyramidCell_m = 0.1;
constexpr int kPyramidLevels = 7;

GridMap draw_map(const Submap& submap, const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node, const MapDrawing& drawing) {
  GridMap map(drawing.resolution_m, drawing.max_extent_m);
  const Pose2 T_first_map = T_map_node[static_cast<std::size_t>(submap.first)].inverse();
  for (int k = submap.first; k <= submap.last; ++k) {
    const auto i = static_cast<std::size_t>(k);
    integrate_scan(keyframes[i].scan, T_first_map * T_map_node[i], drawing.integration, map);
  }
  return map;
}

/// One mean for each square of cells.
std::vector<MatchPoint> surface_points_of(const GridMap& map) {
  std::map<std::pair<int, int>, std::pair<Eigen::Vector2d, double>> squares;  // [row, col]
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        const GridCell& cell = tile.at(col, row);
        if (!cell.is_surface() || cell.hits < 2) continue;
        const Cell at{first.col + col, first.row + row};
        auto& [sum, weight] = squares.try_emplace({at.row >> DrawnSubmap::kPointBits, at.col >> DrawnSubmap::kPointBits}, Eigen::Vector2d::Zero(), 0.0).first->second;
        sum += cell.hits * (map.center_of(at) + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m));
        weight += cell.hits;
      }
    }
  });
  std::vector<MatchPoint> points;
  points.reserve(squares.size());
  for (const auto& [square, sum] : squares) points.push_back({.p_body = sum.first / sum.second, .range_m = 0.0});
  return points;
}

}  // namespace

DrawnSubmap::DrawnSubmap(const Submap& submap, const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node, const MapDrawing& drawing)
    : map_(draw_map(submap, keyframes, T_map_node, drawing)),
      surface_points_(surface_points_of(map_)),
      pyramid_(map_, kPyramidCell_m, kPyramidLevels) {}

}  // namespace patrol::slam
