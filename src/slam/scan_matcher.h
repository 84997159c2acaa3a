#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "slam/grid_map.h"
#include "slam/match_points.h"
#include "slam/pose_gaussian.h"
#include "slam/scan_matcher_settings.h"

namespace patrol::slam {

struct MatchResult {
  Pose2 T_map_body;
  /// Information of the scan alone for x, y, yaw in map, with independent points. A small eigenvalue marks a direction
  /// that the map leaves degenerate, for example along a corridor.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double log_likelihood = 0.0;  ///< log likelihood of the scan at the pose, up to a constant
  double inlier_ratio = 0.0;    ///< inlier ratio: points near a surface / points in observed cells
  int num_matched = 0;
  int iterations = 0;
  bool converged = false;
};

/// Registers points to the map by Gauss-Newton on their distances to the local lines of the map (local_line.h). The
/// lines are fitted again in every iteration.
///
/// Deviation from Gmapping ([Grisetti07]; [Thrun05, section 6.4]), which climbs a likelihood of distances to the mean
/// hits of the cells by steps along each axis. Distances to lines do not pull along a wall, where only the cell pattern
/// varies. They have derivatives: a few iterations converge to a fraction of a millimeter, and the normal equations
/// give the covariance. Points are weighted by a Cauchy kernel; rough surfaces, corners and cells with few hits have
/// smaller weights.
///
/// With a `prior`, its squared Mahalanobis distance is part of the sum, so that odometry constrains the direction along
/// a corridor. Returns none if too few points matched a surface.
///
/// `T_map_known`, if not null, is the pose of an earlier match of the scan. Returns none as soon as an iteration is
/// within 5 mm and 5 mrad of it: another start pose that leads to the same match is of no interest.
std::optional<MatchResult> match_scan(const GridMap& map, const std::vector<MatchPoint>& points,
                                      const Pose2& T_map_start, const std::optional<PoseGaussian>& prior,
                                      const ScanMatcherSettings& settings, const Pose2* T_map_known = nullptr);

/// Log likelihood of a scan at a pose, up to a constant. Unlike in match_scan, points in unobserved cells have the loss
/// of points far from all surfaces; otherwise a search would prefer poses outside the map.
double scan_log_likelihood(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body,
                           const ScanMatcherSettings& settings);

/// Log likelihood of each point, [point]; NaN in unobserved cells. Compare two poses by the points that are not NaN at
/// both.
std::vector<double> point_log_likelihoods(const GridMap& map, const std::vector<MatchPoint>& points,
                                          const Pose2& T_map_body, const ScanMatcherSettings& settings);

/// Correlative scan matching on one level [Olson09]. Returns the pose in the window around `T_map_center` with the most
/// points on or next to a surface cell. Used after odometry slip; the result is within the convergence range of
/// match_scan.
Pose2 search_pose(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_center,
                  const ScanMatcherSettings& settings);

}  // namespace patrol::slam
