#include "slam/surface_overlap.h"

#include "core/point_transform.h"

namespace patrol::slam {

SurfaceOverlap measure_overlap(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_points,
                               int radius) {
  SurfaceOverlap overlap{.num_points = static_cast<int>(points.size())};
  const PointTransform to_map(T_map_points);
  for (const MatchPoint& point : points) {
    const Cell cell = map.cell_at(to_map(point.p_body));
    const bool is_matched = map.is_surface_within(cell, radius);
    const std::optional<GridCell> there = map.find(cell);
    if (!is_matched && (!there || !there->is_observed())) continue;
    ++overlap.num_observed;
    overlap.num_matched += is_matched ? 1 : 0;
  }
  return overlap;
}

}  // namespace patrol::slam
