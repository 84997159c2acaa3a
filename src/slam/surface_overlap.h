#pragma once

#include <vector>

#include "core/frames.h"
#include "slam/grid_map.h"
#include "slam/match_points.h"

namespace patrol::slam {

/// Agreement of points on surfaces with a map.
struct SurfaceOverlap {
  int num_points = 0;
  int num_observed = 0;  ///< points near a surface or in observed cells
  int num_matched = 0;   ///< points near a surface

  double overlap_ratio() const { return num_points == 0 ? 0.0 : static_cast<double>(num_observed) / num_points; }
  double inlier_ratio() const { return num_observed == 0 ? 0.0 : static_cast<double>(num_matched) / num_observed; }
};

/// Counts the points that lie within `radius` cells of a surface of `map`, where it has observed cells.
SurfaceOverlap measure_overlap(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_points,
                               int radius);

}  // namespace patrol::slam
