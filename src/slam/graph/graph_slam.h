#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/pose_graph.h"
#include "core/settings.h"
#include "slam/graph/incremental_map.h"
#include "slam/graph/range_factors.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/scan_tracker.h"
#include "slam/graph/submap.h"
#include "slam/graph/submap_matcher.h"
#include "slam/slam_update.h"

namespace patrol::slam {

struct GraphSlamSettings {
  ScanTrackerSettings scan_odometry;
  // Odometry drift between consecutive submaps, for the prediction of loop closures.
  double drift_std_m_per_m = 0.02;
  double drift_std_rad_per_m = 0.004;
  double drift_std_rad_per_rad = 0.01;
  int max_loop_candidates = 4;  ///< maximum number of older submaps that each new one is matched with, nearest first
  /// Maximum distance between the mean positions of two submaps, plus two standard deviations.
  double max_loop_distance_m = 10.0;
  SubmapMatcherSettings loop_closure;
  PoseGraphSolverSettings solver;
  /// Standard deviation of the systematic error of a match, independent of the number of points.
  double edge_std_m = 0.01;
  double edge_std_rad = 0.001;
  double min_eigenvalue_ratio = 0.02;  ///< a direction is degenerate if its information is below this fraction of the largest
  /// Final optimization: number of passes that match every keyframe with the submaps around it.
  int refinement_iterations = 2;
  int max_refinement_submaps = 3;    ///< maximum number of submaps matched with each keyframe
  double min_refinement_inlier_ratio = 0.6; ///< minimum inlier ratio of a keyframe in a submap
  double max_refinement_m = 0.3;     ///< matches that move a keyframe farther are rejected
  double max_refinement_rad = 0.1;
  int cached_submaps = 16;           ///< maximum number of rendered submaps in the cache
  int min_hits_occupied = 2;
  double min_occupied_hit_ratio = 0.3;
  // Online only.
  double max_tilt_rad = 1.6;  ///< scans tilted by more are not used, for example on a ramp between inclined walls
  double map_update_threshold_m = 0.03;      ///< the map is rendered again if a keyframe or its view at 10 m has moved by more
  RangeUpdateSettings ranges;
  int range_smoothing_period_keyframes = 4;           ///< run the fixed-lag smoothing with UWB ranges every N keyframes

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
    visit("ranges", self.ranges);
    visit("range_smoothing_period_keyframes", self.range_smoothing_period_keyframes, between(1, 1000));
  }
};

/// Numbers of loop closure searches by result.
struct LoopClosureStatistics {
  int searched = 0, closed = 0, not_found = 0, ambiguous = 0, no_overlap = 0, mismatched = 0;

  void add(MatchFailure failure);
};

/// Graph SLAM with submaps, similar to Cartographer [Hess16].
///
///   every scan     track it in a map of the last meters (scan_tracker.h)
///   keyframe       node: an odometry edge to the previous node and a match edge to the matched submap
///   range          where the scan leaves a direction degenerate: constrain the current node in that direction;
///                  every N keyframes optimize the newest submaps with the ranges, older ones are fixed
///   submap full    search the older ones within the drift of odometry (submap_matcher.h); for an unambiguous match
///                  add an edge from submap to submap and optimize the graph
///   finish         render all submaps again, match every keyframe with the surrounding submaps, optimize
///
/// Deviations from [Hess16]:
/// - Submaps are matched with submaps, not scans with submaps: ten meters of walls are distinctive where a scan is not.
/// - The search window follows from the graph, and a second-best match of similar score rejects the best.
/// - Edges are weighted with the information of the match: along a corridor a loop closure does not constrain.
/// - Submaps are not stored but rendered from their scans at the current poses, so memory grows with the scans only.
class GraphSlam {
 public:
  explicit GraphSlam(const GraphSlamSettings& settings);

  /// Adds a UWB range measured before the next scan. It is rejected if NLOS (range_update.h), and unused if the scan
  /// constrains both directions.
  void add(const RangeMeasurement& measurement) { new_ranges_.push_back(measurement); }
  /// Processes a scan; `T_odom_body` is the odometry at its stamp. The covariance is that of the pose in a map without
  /// errors.
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  /// Finishes mapping after the last scan: closes the remaining loops and refines all keyframes.
  void finish();

  /// Current pose estimates of all scans, [scan].
  std::vector<Pose2> path() const;
  const PoseGraph& graph() const { return graph_; }
  /// Scan index of each keyframe, [keyframe].
  std::vector<std::size_t> node_scan_indices() const;
  const LoopClosureStatistics& loop_closure_statistics() const { return loop_closure_statistics_; }
  OccupancyGrid map();

 private:
  /// Tracked pose of a scan and its preceding keyframe.
  struct TrackedPose {
    int keyframe;
    Pose2 T_local_body;
  };

  struct LoopEdge {
    int target, source;  ///< submap indices
    int edge;
  };

  void add_keyframe(const LevelScan& scan, const TrackedScan& tracked);
  void add_match_edge(const TrackedScan& tracked);
  Pose2 T_map_body(const Pose2& T_local_body) const;
  void update_estimate(const TrackedScan& tracked, Time stamp);
  void gate_ranges(const TrackedScan& tracked, const Pose2& T_odom_body);
  void smooth_with_ranges(int submap);
  void close_loops(int submap);
  std::vector<PoseGaussian> relative_pose_distributions(int submap) const;
  Eigen::Matrix3d odometry_drift_covariance(int submap) const;
  std::shared_ptr<const RenderedSubmap> rendered(int submap);
  std::vector<int> submaps_near(int source, const std::vector<PoseGaussian>& around) const;
  std::vector<std::vector<int>> keyframes_around_submaps() const;
  void refine();
  std::optional<MatchResult> refined(const RenderedSubmap& submap, const Keyframe& keyframe, const Pose2& T_submap_body) const;
  Eigen::Matrix3d observable_information(const Eigen::Matrix3d& match_information) const;
  Eigen::Matrix3d match_edge_information(const Eigen::Matrix3d& match_information) const;
  Pose2 T_map_submap(int submap) const { return graph_.T_map_node[static_cast<std::size_t>(submaps_[static_cast<std::size_t>(submap)].first)]; }
  Eigen::Vector2d submap_center(int submap) const;

  GraphSlamSettings settings_;
  MapRenderingSettings rendering_;
  ScanTracker tracker_;
  std::vector<Keyframe> keyframes_;
  std::vector<TrackedPose> path_;
  std::vector<Submap> submaps_;
  int finished_submaps_ = 0;
  PoseGraph graph_;
  SubmapCache cache_;
  std::vector<LoopEdge> loops_;
  LoopClosureStatistics loop_closure_statistics_;
  IncrementalMap incremental_map_;
  bool is_finished_ = false;
  PoseGaussian now_;  ///< current pose in map
  Time stamp_{};
  std::vector<RangeMeasurement> new_ranges_;  ///< not yet gated
  RangeFactors ranges_;
  int smoothed_until_ = 0;  ///< newest node moved by the ranges
};

}  // namespace patrol::slam
