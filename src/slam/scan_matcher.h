#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/settings.h"
#include "slam/grid_map.h"
#include "slam/match_points.h"
#include "slam/pose_gaussian.h"

namespace patrol::slam {

struct ScanMatcherSettings {
  int max_points = 800;                  ///< of a scan that are matched
  double point_spacing_m = 0.08;         ///< beams nearer together than this are averaged
  double point_std_m = 0.015;            ///< of a point's range
  double point_angle_std_rad = 0.0005;   ///< of its direction
  double kernel_m = 0.05;                ///< from here on a point counts as an outlier, gradually
  int surface_radius_cells = 3;          ///< neighbourhood that makes a piece of surface; also how far off a point may start
  int max_iterations = 8;
  double min_matched_share = 0.3;        ///< fewer matched points are no match
  double search_window_m = 0.3;          ///< of the coarse search, each way
  double search_window_rad = 0.12;
  int search_points = 200;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(3, 100000));
    visit("point_spacing_m", self.point_spacing_m, between(0.0, 5.0));
    visit("point_std_m", self.point_std_m, between(1e-4, 1.0));
    visit("point_angle_std_rad", self.point_angle_std_rad, between(0.0, 0.1));
    visit("kernel_m", self.kernel_m, between(1e-3, 10.0));
    visit("surface_radius_cells", self.surface_radius_cells, between(1, 10));
    visit("max_iterations", self.max_iterations, between(1, 100));
    visit("min_matched_share", self.min_matched_share, between(0.0, 1.0));
    visit("search_window_m", self.search_window_m, between(0.0, 5.0));
    visit("search_window_rad", self.search_window_rad, between(0.0, 1.6));
    visit("search_points", self.search_points, between(3, 10000));
  }
};

struct MatchResult {
  Pose2 T_map_body;
  /// Of the scan alone, as if its points were independent; x, y, yaw in map. A small eigenvalue is a direction in which
  /// the map says nothing (along a corridor).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double log_likelihood = 0.0;  ///< of the scan at the pose, up to a constant
  double matched_share = 0.0;   ///< points with a surface near, of those that fell where the map knows anything
  int num_matched = 0;
  int iterations = 0;
  bool converged = false;
};

/// Lays points on the map by Gauss-Newton on their distances to the local lines of the map (local_line.h), found anew in
/// every iteration.
///
/// Gmapping climbs a likelihood of distances to the cells' mean hits by steps along each axis (Grisetti et al. 2007;
/// Thrun et al. 2005, section 6.4). Distances to lines leave out the pull along a wall, which is only the pattern of
/// cells, and have derivatives: a few iterations reach a fraction of a millimetre, and the sum of squares is the
/// covariance too. Points count by a Cauchy kernel; rough surfaces, corners and young cells count less.
///
/// With a `prior` its squared Mahalanobis distance is part of the sum, so that a corridor's length is left to odometry.
/// None if too few points met a surface.
std::optional<MatchResult> match_scan(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_start,
                                      const std::optional<PoseGaussian>& prior, const ScanMatcherSettings& settings);

/// Log likelihood of a scan at a pose, up to a constant; unlike a match's, points on cells of which nothing is known count as far from all surfaces, or
/// else a search would do best to leave the map.
double scan_log_likelihood(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body, const ScanMatcherSettings& settings);

/// [point]: the same for each point alone; NaN where the map knows nothing. Two poses are fairly compared by the points of which it knows something under both.
std::vector<double> point_log_likelihoods(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body, const ScanMatcherSettings& settings);

/// The pose in the window around `T_map_center` that puts most points on a surface cell or beside one: correlative matching
/// (Olson, "Real-time correlative scan matching", ICRA 2009) on one level. For when odometry has slipped; ends within
/// reach of match_scan.
Pose2 search_pose(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_center,
                  const ScanMatcherSettings& settings);

}  // namespace patrol::slam
