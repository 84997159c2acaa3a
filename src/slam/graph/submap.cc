#include "slam/graph/submap.h"

#include "slam/surface_points.h"

namespace patrol::slam {
namespace {

constexpr double kPyramidCell_m = 0.1;
constexpr int kSubmapPyramidLevels = 7;

GridMap render_submap(const Submap& submap, const std::vector<Keyframe>& keyframes,
                      const std::vector<Pose2>& T_map_node, const MapRenderingSettings& rendering) {
  GridMap map(rendering.resolution_m, rendering.max_extent_m);
  const Pose2 T_first_map = T_map_node[static_cast<std::size_t>(submap.first)].inverse();
  for (int k = submap.first; k <= submap.last; ++k) {
    const auto i = static_cast<std::size_t>(k);
    keyframes[i].scans.integrate(T_first_map * T_map_node[i], rendering.integration, map);
  }
  return map;
}

std::vector<MatchPoint> surface_points_of(const GridMap& map) {
  std::vector<MatchPoint> points;
  for (const Eigen::Vector2d& p : surface_points(map)) points.push_back({.p_body = p, .range_m = 0.0});
  return points;
}

}  // namespace

RenderedSubmap::RenderedSubmap(const Submap& submap, const std::vector<Keyframe>& keyframes,
                               const std::vector<Pose2>& T_map_node, const MapRenderingSettings& rendering)
    : map_(render_submap(submap, keyframes, T_map_node, rendering)),
      surface_points_(surface_points_of(map_)),
      pyramid_(map_, kPyramidCell_m, kSubmapPyramidLevels),
      T_map_node_(T_map_node.begin() + submap.first, T_map_node.begin() + submap.last + 1) {}

}  // namespace patrol::slam
