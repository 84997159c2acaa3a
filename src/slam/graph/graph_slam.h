#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/pose_graph.h"
#include "core/settings.h"
#include "slam/graph/live_map.h"
#include "slam/graph/node_ranges.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/scan_tracker.h"
#include "slam/graph/submap.h"
#include "slam/graph/submap_matcher.h"
#include "slam/slam_update.h"

namespace patrol::slam {

struct GraphSlamSettings {
  ScanTrackerSettings tracking;
  // Where a submap may lie, as far as the way from one to the other says.
  double drift_std_m_per_m = 0.02;
  double drift_std_rad_per_m = 0.004;
  double drift_std_rad_per_rad = 0.01;
  int max_loop_candidates = 4;       ///< for each new submap: the nearest older ones
  double max_loop_distance_m = 10.0; ///< between the middles of their ways, beyond what is uncertain
  SubmapMatcherSettings loops;
  PoseGraphSolverSettings solver;
  double edge_std_m = 0.01;          ///< of a match's systematic error, however many points it has
  double edge_std_rad = 0.001;
  double open_share = 0.02;          ///< a direction in which a match says less than this share of what it says in the best one is open
  int refinement_rounds = 2;         ///< at the end: every keyframe is matched with the submaps around it
  int max_refinement_submaps = 3;    ///< of each keyframe
  double min_refinement_share = 0.6; ///< of a keyframe's points that meet the submap's surfaces
  double max_refinement_m = 0.3;     ///< a keyframe that would move farther has been matched wrongly
  double max_refinement_rad = 0.1;
  int cached_submaps = 16;           ///< drawn at a time
  int min_hits_occupied = 2;
  double min_hit_share_occupied = 0.3;
  // Online.
  double max_tilt_rad = 1.6;         ///< a scan tilted by more is taken for blind, as on a ramp between walls that lean
  double redraw_shift_m = 0.03;      ///< the map is drawn anew when what a keyframe sees ten metres away has moved farther
  RangeUpdateSettings ranges;
  int range_keyframes = 4;           ///< so often the newest submaps are laid by the ranges

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("tracking", self.tracking);
    visit("drift_std_m_per_m", self.drift_std_m_per_m, at_least(0.0));
    visit("drift_std_rad_per_m", self.drift_std_rad_per_m, at_least(0.0));
    visit("drift_std_rad_per_rad", self.drift_std_rad_per_rad, at_least(0.0));
    visit("max_loop_candidates", self.max_loop_candidates, between(0, 1000));
    visit("max_loop_distance_m", self.max_loop_distance_m, at_least(0.0));
    visit("loops", self.loops);
    visit("solver", self.solver);
    visit("edge_std_m", self.edge_std_m, between(1e-5, 1.0));
    visit("edge_std_rad", self.edge_std_rad, between(1e-6, 1.0));
    visit("open_share", self.open_share, between(0.0, 1.0));
    visit("refinement_rounds", self.refinement_rounds, between(0, 100));
    visit("max_refinement_submaps", self.max_refinement_submaps, between(1, 100));
    visit("min_refinement_share", self.min_refinement_share, between(0.0, 1.0));
    visit("max_refinement_m", self.max_refinement_m, at_least(0.0));
    visit("max_refinement_rad", self.max_refinement_rad, at_least(0.0));
    visit("cached_submaps", self.cached_submaps, between(1, 10000));
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_hit_share_occupied", self.min_hit_share_occupied, between(0.0, 1.0));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("redraw_shift_m", self.redraw_shift_m, at_least(0.0));
    visit("ranges", self.ranges);
    visit("range_keyframes", self.range_keyframes, between(1, 1000));
  }
};

/// What became of the search for loops.
struct LoopCounts {
  int searched = 0, closed = 0, not_found = 0, ambiguous = 0, no_overlap = 0, mismatched = 0;

  void add(MatchFailure failure);
};

/// Mapping by submaps and a pose graph, of the class of Cartographer (Hess, Kohler, Rapp, Andor, "Real-time loop closure in 2D lidar SLAM", ICRA 2016).
///
///   every scan     follow it within a map of the last metres (scan_tracker.h)
///   a keyframe     a node: an edge of odometry to the one before, one of its match to the submap that it was matched with
///   ranges         where the scan leaves a direction open, belong to the node around which they were read, and hold it in that direction; every few nodes
///                  the newest submaps are laid by them, the older ones staying where they are
///   a submap full  look for the older ones around it, as far as drift may have taken it (submap_matcher.h); where one fits, and fits in one way only,
///                  an edge from submap to submap; solve the graph
///   the end        draw all submaps anew, match every keyframe with those around it that it is no part of, solve
///
/// Differences, and why. Submaps are matched with submaps rather than scans with submaps: ten metres of walls are told from others where a scan is not.
/// How far to look comes from the graph, and a second place that fits as well makes the first worthless. Matches are weighed by what they saw: along
/// a corridor a closure ties nothing. Submaps are not kept but drawn from their scans, at the poses that are believed now; so memory grows by scans only.
class GraphSlam {
 public:
  explicit GraphSlam(const GraphSlamSettings& settings);

  /// A UWB range of before the next scan. One that went round a corner is left out (range_update.h), and so is all of them where scans tell the place.
  void add(const RangeSighting& sighting) { new_ranges_.push_back(sighting); }
  /// `T_odom_body` at the scan's stamp. The covariance is that of the pose in a map that is exact.
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  /// No scan will follow.
  void finish();

  /// [scan]: of every scan that was given, as is believed now.
  std::vector<Pose2> path() const;
  const PoseGraph& graph() const { return graph_; }
  /// [keyframe]: the number of its scan.
  std::vector<std::size_t> node_scans() const;
  const LoopCounts& loop_counts() const { return loop_counts_; }
  OccupancyGrid map();

 private:
  /// A scan beside the keyframe before it.
  struct TrackedPose {
    int keyframe;
    Pose2 T_local_body;
  };

  struct LoopEdge {
    int target, source;  ///< submaps
    int edge;
  };

  void add_keyframe(const LevelScan& scan, const TrackedScan& tracked);
  void add_match_edge(const TrackedScan& tracked);
  Pose2 T_map_body(const Pose2& T_local_body) const;
  void believe(const TrackedScan& tracked, Time stamp);
  void accept_ranges(const TrackedScan& tracked, const Pose2& T_odom_body);
  void lay_by_ranges(int submap);
  void close_loops(int submap);
  std::vector<PoseGaussian> positions_around(int submap) const;
  Eigen::Matrix3d drift_after(int submap) const;
  std::shared_ptr<const DrawnSubmap> drawn(int submap);
  std::vector<int> submaps_near(int source, const std::vector<PoseGaussian>& around) const;
  std::vector<std::vector<int>> keyframes_around_submaps() const;
  void refine();
  std::optional<MatchResult> refined(const DrawnSubmap& submap, const Keyframe& keyframe, const Pose2& T_submap_body) const;
  Eigen::Matrix3d known_by(const Eigen::Matrix3d& match_information) const;
  Eigen::Matrix3d weight_of(const Eigen::Matrix3d& match_information) const;
  Pose2 T_map_submap(int submap) const { return graph_.T_map_node[static_cast<std::size_t>(submaps_[static_cast<std::size_t>(submap)].first)]; }
  Eigen::Vector2d middle_of(int submap) const;

  GraphSlamSettings settings_;
  MapDrawing drawing_;
  ScanTracker tracker_;
  std::vector<Keyframe> keyframes_;
  std::vector<TrackedPose> path_;
  std::vector<Submap> submaps_;
  int finished_submaps_ = 0;
  PoseGraph graph_;
  SubmapCache cache_;
  std::vector<LoopEdge> loops_;
  LoopCounts loop_counts_;
  LiveMap live_map_;
  bool is_finished_ = false;
  PoseGaussian now_;  ///< in map
  Time stamp_{};
  std::vector<RangeSighting> new_ranges_;  ///< not yet judged
  NodeRanges ranges_;
  int laid_until_ = 0;  ///< the newest node that they have moved
};

}  // namespace patrol::slam
