#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/pose_graph.h"
#include "slam/graph/graph_slam_settings.h"
#include "slam/graph/incremental_map.h"
#include "slam/graph/loop_closure_statistics.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/scan_tracker.h"
#include "slam/graph/submap.h"
#include "slam/graph/submap_graph.h"
#include "slam/graph/submap_matcher.h"
#include "slam/mapped_range.h"
#include "slam/slam_update.h"

namespace patrol::slam {

/// Graph SLAM with submaps, similar to Cartographer [Hess16].
///
///   every scan     track it in a map of the last meters (scan_tracker.h)
///   keyframe       node: an odometry edge to the previous node and a match edge to the matched submap
///   range          constrain the current node; every N keyframes optimize the newest submaps with the ranges, older
///                  ones are fixed
///   position       constrain the current node, where a survey's position of an antenna is measured
///   submap full    search the older ones within the drift of odometry (submap_matcher.h); for an unambiguous match
///                  add an edge from submap to submap and optimize the graph, also with new positions
///   finish         render all submaps again, match every keyframe with the surrounding submaps, optimize
///
/// A session can extend the map of earlier sessions (extend). Its submaps are searched in the whole earlier map until
/// two of them agree on its pose; from then on it is part of one graph, with loop closures to the earlier submaps.
///
/// Deviations from [Hess16]:
/// - Submaps are matched with submaps, not scans with submaps: ten meters of walls are distinctive where a scan is not.
/// - The search window follows from the graph, and a second-best match of similar score or similar inlier ratio rejects
///   the best.
/// - Edges are weighted with the information of the match: along a corridor a loop closure does not constrain.
/// - Submaps are not stored but rendered from their scans at the current poses, so memory grows with the scans only.
class GraphSlam {
 public:
  explicit GraphSlam(const GraphSlamSettings& settings);

  /// Extends a map of earlier sessions, before the first scan.
  void extend(const SubmapGraph& earlier);

  /// Adds a UWB range measured before the next scan. It is rejected if NLOS (range_update.h).
  void add(const RangeMeasurement& measurement) { new_ranges_.push_back(measurement); }
  /// Adds the position of an antenna in a survey in which map has its origin, roughly.
  void add(const PositionMeasurement& measurement) { new_positions_.push_back(measurement); }
  /// Processes a scan; `T_odom_body` is the odometry at its stamp. The covariance is that of the pose in a map without
  /// errors.
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);
  /// Finishes mapping after the last scan: closes the remaining loops and refines all keyframes.
  void finish();

  /// Whether the pose of this session in the earlier map is known; true without an earlier map. After `finish`, a
  /// session that was not located is a map of its own.
  bool is_located() const { return is_located_; }

  /// Current pose estimates of all scans of this session, [scan].
  std::vector<Pose2> path() const;
  /// Nodes and edges of all sessions.
  const PoseGraph& graph() const { return graph_; }
  /// Map for later sessions, after `finish`: the earlier submaps, and the submaps of this session that show places that
  /// the others do not, or that have changed. The number of nodes thus grows with the mapped area and its changes, not
  /// with the number of sessions.
  SubmapGraph submap_graph() const;
  /// Scan index of each keyframe of this session, [keyframe].
  std::vector<std::size_t> node_scan_indices() const;
  /// UWB ranges in line of sight along the path.
  std::vector<MappedRange> mapped_ranges() const;
  const LoopClosureStatistics& loop_closure_statistics() const { return loop_closure_statistics_; }
  OccupancyGrid map();

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(tracker_, keyframes_, matches_, path_, submaps_, finished_submaps_, first_keyframe_, first_submap_,
            is_located_, earlier_map_, located_, last_located_keyframe_, graph_, loops_, loop_closure_statistics_,
            is_finished_, now_, stamp_, new_ranges_, new_positions_, survey_, smoothed_until_);
    incremental_map_.serialize_state(archive, keyframes_);
    cache_.serialize_state(
        archive, [this](int submap, const std::vector<Pose2>& T_map_node) { return render_again(submap, T_map_node); });
  }

 private:
  /// Tracked pose of a scan and its preceding keyframe.
  struct TrackedPose {
    int keyframe = 0;
    Pose2 T_local_body;
  };

  /// Match of a keyframe with the map.
  struct KeyframeMatch {
    bool is_matched = false;
    /// Direction along which the match does not determine the position, in the frame of the keyframe; zero: none.
    Eigen::Vector2d undetermined = Eigen::Vector2d::Zero();
  };

  /// Drift between submaps: of the odometry alone, or of the scans tracked with it.
  enum class Drift { kOdometry, kTracked };

  struct LoopEdge {
    int target, source;  ///< submap indices
    int edge;
  };

  /// Submap of this session that was found in the earlier map.
  struct LocatedSubmap {
    int submap = 0;
    Pose2 T_map_submap;
  };

  void add_keyframe(const TrackedScan& tracked);
  void add_match_edge(const TrackedScan& tracked);
  Pose2 T_map_body(const Pose2& T_local_body) const;
  void update_estimate(const TrackedScan& tracked, Time stamp);
  void gate_ranges(const TrackedScan& tracked, const Pose2& T_odom_body);
  void add_positions(const TrackedScan& tracked, const Pose2& T_odom_body);
  void smooth_with_ranges(int submap);
  void close_loops(int source);
  bool add_loops(int source, const std::vector<PoseGaussian>& around);
  void optimize();
  std::vector<PoseGaussian> relative_pose_distributions(int submap, Drift drift = Drift::kOdometry) const;
  Eigen::Matrix3d limited_by_survey(const Eigen::Matrix3d& covariance, int target, int source) const;
  Eigen::Matrix3d drift_covariance(int submap, Drift drift) const;
  std::shared_ptr<const RenderedSubmap> rendered(int submap);
  /// Renders a submap at the poses of its keyframes at another time.
  std::shared_ptr<const RenderedSubmap> render_again(int submap, const std::vector<Pose2>& T_map_submap_node) const;
  std::vector<int> submaps_near(int source, const std::vector<PoseGaussian>& around) const;
  std::vector<std::vector<int>> keyframes_around_submaps() const;
  void locate(int source);
  bool agree(const LocatedSubmap& a, const LocatedSubmap& b) const;
  bool align_session(const LocatedSubmap& located);
  void locate_by_single_submap();
  void remove_earlier_map();
  void restore_map_frame();
  std::vector<bool> kept_submaps() const;
  void refine();
  std::optional<MatchResult> refined(const RenderedSubmap& submap, const Keyframe& keyframe,
                                     const Pose2& T_submap_body) const;
  Eigen::Matrix3d observable_information(const Eigen::Matrix3d& match_information) const;
  Eigen::Matrix3d match_edge_information(const Eigen::Matrix3d& match_information) const;
  Pose2 T_map_submap(int submap) const {
    return graph_.T_map_node[static_cast<std::size_t>(submaps_[static_cast<std::size_t>(submap)].first)];
  }
  Eigen::Vector2d submap_center(int submap) const;
  bool has_earlier_map() const { return first_keyframe_ > 0; }
  bool is_surveyed(const Submap& submap) const { return survey_.constrain(submap.first, submap.last); }

  GraphSlamSettings settings_;
  MapRenderingSettings rendering_;
  ScanTracker tracker_;
  std::vector<Keyframe> keyframes_;
  std::vector<KeyframeMatch> matches_;  ///< [keyframe of this session]
  std::vector<TrackedPose> path_;
  std::vector<Submap> submaps_;
  int finished_submaps_ = 0;
  int first_keyframe_ = 0, first_submap_ = 0;  ///< indices of the first keyframe and submap of this session
  bool is_located_ = true;
  std::optional<RenderedSubmap> earlier_map_;  ///< earlier map as one submap, while the session is not located
  std::vector<LocatedSubmap> located_;
  int last_located_keyframe_ = -1;  ///< last keyframe of the last submap that was searched in the earlier map
  PoseGraph graph_;
  SubmapCache cache_;
  std::vector<LoopEdge> loops_;
  LoopClosureStatistics loop_closure_statistics_;
  IncrementalMap incremental_map_;
  bool is_finished_ = false;
  PoseGaussian now_;  ///< current pose in map
  Time stamp_{};
  std::vector<RangeMeasurement> new_ranges_;        ///< ranges that are not yet gated
  std::vector<PositionMeasurement> new_positions_;  ///< positions that are not yet added
  SurveyFactors survey_;
  int smoothed_until_ = 0;  ///< newest node moved by the ranges
};

}  // namespace patrol::slam
