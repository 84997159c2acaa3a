#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/grid.h"
#include "core/pose_graph.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/relative_covariance.h"
#include "slam/graph/scan_tracker.h"
#include "slam/submaps/submap_builder.h"
#include "slam/submaps/submap_constraint_finder.h"
#include "slam/submaps/submap_rbpf_settings.h"

namespace patrol::slam {

/// Mapping with submaps built by a particle filter [Yu23].
///
///   every scan     track it (scan_tracker.h); the particles of the open submap start from there (submap_builder.h)
///   submap full    its best particle becomes the submap and the filter restarts; compare the submap with nearby older
///                  ones, connect recognized neighbors by constraints (submap_constraint_finder.h) and optimize the
///                  submap graph, with a robust kernel on the constraints
///   finish         render the scans of all submaps at their poses
///
/// Deviation from [Yu23]: submaps are compared when they are full, not at the end of the loop, so that the next one is
/// predicted correctly. Memory: the particle maps are freed with their submap; scans and surfaces are kept.
class SubmapRbpf {
 public:
  /// `neighbors` classifies submap pairs by their features (pair_features.h). Throws InputError if a setting is
  /// invalid.
  SubmapRbpf(const SubmapRbpfSettings& settings, BoostedStumps neighbors, std::uint64_t seed);

  /// Processes a scan and returns the current body pose in map.
  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body);
  /// Finishes mapping after the last scan.
  void finish();

  /// Current pose estimates of all scans, [scan].
  std::vector<Pose2> path() const;
  /// Pose graph whose nodes are the submaps.
  const PoseGraph& graph() const { return graph_; }
  std::vector<std::size_t> node_scan_indices() const { return first_scans_; }
  OccupancyGrid map() const;

  /// Result of comparing two submaps.
  struct Comparison {
    int target = 0, source = 0;
    PoseGaussian T_target_source;  ///< predicted relative pose
    ConstraintResult result;
  };
  const std::vector<Comparison>& comparisons() const { return comparisons_; }
  /// Index of the first scan of each submap, [submap].
  const std::vector<std::size_t>& first_scans() const { return first_scans_; }
  /// Surfaces of a full submap; none if too few surface points were observed.
  const std::optional<SubmapSurfaces>& surfaces_of(int submap) const {
    return submaps_[static_cast<std::size_t>(submap)].surfaces;
  }

 private:
  /// Full submap, rigid from then on.
  struct Submap {
    std::vector<Keyframe> keyframes;
    std::vector<Pose2> T_submap_body;  ///< [scan]
    std::optional<SubmapSurfaces> surfaces;
  };

  void begin_submap();
  void close_submap();
  void add_odometry_edge(const SubmapBuilder& before);
  void add_loop_closures(int source);
  std::vector<PoseGaussian> relative_pose_distributions(int submap) const;
  std::vector<int> candidates_for(int source, const std::vector<PoseGaussian>& around) const;

  SubmapRbpfSettings settings_;
  BoostedStumps neighbors_;
  std::uint64_t seed_;
  ScanTracker tracker_;
  std::optional<SubmapBuilder> builder_;
  std::vector<Submap> submaps_;  ///< full submaps
  std::vector<std::size_t> first_scans_;
  std::size_t num_scans_ = 0;
  PoseGraph graph_;  ///< nodes are the submaps, the last one is the open submap
  std::vector<CovarianceEdge> covariance_edges_;
  std::vector<Comparison> comparisons_;
};

}  // namespace patrol::slam
