#pragma once

#include "core/settings.h"
#include "slam/graph/pose_graph_solver_settings.h"
#include "slam/graph/position_factors_settings.h"
#include "slam/graph/scan_tracker_settings.h"
#include "slam/graph/submap_matcher_settings.h"
#include "slam/range_update_settings.h"

namespace patrol::slam {

struct GraphSlamSettings {
  ScanTrackerSettings scan_odometry;
  // Odometry drift between consecutive submaps, for the prediction of loop closures.
  double drift_std_m_per_m = 0.02;      ///< drift of the position over the distance between submaps
  double drift_std_rad_per_m = 0.004;   ///< drift of the yaw over the distance between submaps
  double drift_std_rad_per_rad = 0.01;  ///< drift of the yaw over the rotation between submaps
  int max_loop_candidates = 4;  ///< maximum number of older submaps that each new one is matched with, nearest first
  /// Maximum distance between the mean positions of two submaps, plus two standard deviations.
  double max_loop_distance_m = 10.0;
  SubmapMatcherSettings loop_closure;
  PoseGraphSolverSettings solver;
  /// Standard deviation of the systematic error of a match, independent of the number of points.
  double edge_std_m = 0.01;
  /// Standard deviation of the systematic yaw error of a match, independent of the number of points.
  double edge_std_rad = 0.001;
  double min_eigenvalue_ratio =
      0.02;  ///< information along a direction, relative to the largest, below which the direction is degenerate
  /// Final optimization: number of passes that match every keyframe with the submaps around it.
  int refinement_iterations = 2;
  int max_refinement_submaps = 3;            ///< maximum number of submaps matched with each keyframe
  double min_refinement_inlier_ratio = 0.6;  ///< minimum inlier ratio of a keyframe in a submap
  double max_refinement_m = 0.3;  ///< largest displacement of a keyframe by an accepted match of the final optimization
  double max_refinement_rad = 0.1;  ///< largest rotation of a keyframe by an accepted match of the final optimization
  int cached_submaps = 16;          ///< maximum number of rendered submaps in the cache
  int min_hits_occupied = 2;        ///< minimum number of hits of an occupied cell of the published map
  /// Minimum ratio of hits to hits plus passes of an occupied cell of the published map.
  double min_occupied_hit_ratio = 0.3;
  // Online only.
  double max_tilt_rad = 1.6;  ///< tilt above which scans are not used, for example on a ramp between inclined walls
  double map_update_threshold_m =
      0.03;  ///< displacement of a keyframe, or of its view at 10 m, above which the map is rendered again
  /// Standard deviation of the position of submaps that ranges or positions constrain, which limits the search for loop
  /// closures: in a tunnel, one ring resembles the next.
  double surveyed_submap_std_m = 0.3;
  RangeUpdateSettings ranges;
  PositionFactorsSettings positions;
  /// Number of keyframes from one fixed-lag smoothing with UWB ranges to the next.
  int range_smoothing_period_keyframes = 4;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scan_odometry", self.scan_odometry);
    visit("drift_std_m_per_m", self.drift_std_m_per_m, at_least(0.0));
    visit("drift_std_rad_per_m", self.drift_std_rad_per_m, at_least(0.0));
    visit("drift_std_rad_per_rad", self.drift_std_rad_per_rad, at_least(0.0));
    visit("max_loop_candidates", self.max_loop_candidates, between(0, 1000));
    visit("max_loop_distance_m", self.max_loop_distance_m, at_least(0.0));
    visit("loop_closure", self.loop_closure);
    visit("solver", self.solver);
    visit("edge_std_m", self.edge_std_m, between(1e-5, 1.0));
    visit("edge_std_rad", self.edge_std_rad, between(1e-6, 1.0));
    visit("min_eigenvalue_ratio", self.min_eigenvalue_ratio, between(0.0, 1.0));
    visit("refinement_iterations", self.refinement_iterations, between(0, 100));
    visit("max_refinement_submaps", self.max_refinement_submaps, between(1, 100));
    visit("min_refinement_inlier_ratio", self.min_refinement_inlier_ratio, between(0.0, 1.0));
    visit("max_refinement_m", self.max_refinement_m, at_least(0.0));
    visit("max_refinement_rad", self.max_refinement_rad, at_least(0.0));
    visit("cached_submaps", self.cached_submaps, between(1, 10000));
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_occupied_hit_ratio", self.min_occupied_hit_ratio, between(0.0, 1.0));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("map_update_threshold_m", self.map_update_threshold_m, at_least(0.0));
    visit("surveyed_submap_std_m", self.surveyed_submap_std_m, between(1e-3, 1e3));
    visit("ranges", self.ranges);
    visit("positions", self.positions);
    visit("range_smoothing_period_keyframes", self.range_smoothing_period_keyframes, between(1, 1000));
  }
};

}  // namespace patrol::slam
