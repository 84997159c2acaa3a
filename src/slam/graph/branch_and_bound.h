#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "slam/graph/likelihood_pyramid.h"

namespace patrol::slam {

/// Square of positions and range of angles around a center pose.
struct SearchWindow {
  Pose2 T_map_center;
  double half_width_m = 1.0;
  double half_angle_rad = 0.2;
};

/// Neighborhood of a pose that is excluded from a search, to find other matches.
struct SearchExclusion {
  Pose2 T_map_center;
  double radius_m = 1.0;
  double angle_rad = 0.3;
};

struct SearchResult {
  Pose2 T_map_points;
  double score = 0.0;  ///< mean likelihood of the points, 1 if all are on surfaces; negative: in free space
};

/// Returns the pose with the highest score in the window, if the score exceeds `min_score`. Exact branch and bound over
/// nested squares of positions [Hess16, algorithm 3]. The step is one cell of the finest level in position, and in
/// angle the rotation that moves the farthest point by one cell. Returns none if no pose qualifies or there are no
/// points.
std::optional<SearchResult> search_window(const LikelihoodPyramid& map, const std::vector<Eigen::Vector2d>& points,
                                          const SearchWindow& window, double min_score,
                                          std::span<const SearchExclusion> exclusions = {});

}  // namespace patrol::slam
