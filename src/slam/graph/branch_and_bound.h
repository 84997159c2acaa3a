#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/frames.h"
#include "slam/graph/likelihood_pyramid.h"

namespace patrol::slam {

/// Poses around a centre.
struct SearchWindow {
  Pose2 T_map_center;
  double half_width_m = 1.0;
  double half_angle_rad = 0.2;
};

/// A pose and its neighbourhood that are left out, to see what else is there.
struct SearchExclusion {
  Pose2 T_map_center;
  double radius_m = 1.0;
  double angle_rad = 0.3;
};

struct SearchResult {
  Pose2 T_map_points;
  double score = 0.0;  ///< mean of the points' likelihoods, 1 when all lie on surfaces; negative: in free space
};

/// The pose of the window under which the points fit the map best, of all that score more than `min_score`: exactly, by branch and bound over
/// ever smaller squares of positions (Hess et al., ICRA 2016, algorithm 3). Steps are a cell of the finest level, and the angle by which the
/// farthest point moves a cell. None if there is none, or no point is given.
std::optional<SearchResult> search_window(const LikelihoodPyramid& map, const std::vector<Eigen::Vector2d>& points, const SearchWindow& window,
                                          double min_score, const std::optional<SearchExclusion>& exclusion = std::nullopt);

}  // namespace patrol::slam
