#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/grid.h"
#include "core/pose_graph.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/scan_tracker.h"
#include "slam/graph/relative_covariance.h"
#include "slam/submaps/submap_builder.h"
#include "slam/submaps/submap_constraint_finder.h"

namespace patrol::slam {

struct SubmapRbpfSettings {
  ScanTrackerSettings scan_odometry;
  SubmapBuilderSettings submaps;
  SubmapSurfaceSettings surfaces;
  SubmapConstraintSettings constraints;
  // Odometry drift over a submap, for the prediction of loop closures.
  double drift_std_m_per_m = 0.003;
  double drift_std_rad_per_m = 0.0005;
  double drift_std_rad_per_rad = 0.005;
  int max_candidates = 8;        ///< maximum number of older submaps compared with each new one, nearest first
  double likelihood_tempering = 0.2;       ///< tempering factor: fraction of the matched points with independent errors
  /// Standard deviation of the systematic error of a match, independent of the number of points.
  double constraint_std_m = 0.02;
  double constraint_std_rad = 0.002;
  /// Narrow kernel: each submap has many constraints, of which only a few need to be inliers.
  PoseGraphSolverSettings solver = {.max_iterations = 50, .robust_loop_closures = true, .loop_closure_loss_scale = 0.3};
  int min_hits_occupied = 2;
  double min_occupied_hit_ratio = 0.3;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scan_odometry", self.scan_odometry);
    visit("submaps", self.submaps);
    visit("surfaces", self.surfaces);
    visit("constraints", self.constraints);
    visit("drift_std_m_per_m", self.drift_std_m_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_m", self.drift_std_rad_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_rad", self.drift_std_rad_per_rad, at_least(0.0));
    visit("max_candidates", self.max_candidates, between(0, 10000));
    visit("likelihood_tempering", self.likelihood_tempering, between(0.0, 1.0));
    visit("constraint_std_m", self.constraint_std_m, between(1e-5, 1.0));
    visit("constraint_std_rad", self.constraint_std_rad, between(1e-6, 1.0));
    visit("solver", self.solver);
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_occupied_hit_ratio", self.min_occupied_hit_ratio, between(0.0, 1.0));
  }
};

/// Mapping with submaps built by a particle filter [Yu23].
///
///   every scan     track it (scan_tracker.h); the particles of the open submap start from there (submap_builder.h)
///   submap full    its best particle becomes the submap and the filter restarts; compare the submap with nearby older
///                  ones, connect recognized neighbors by constraints (submap_joiner.h) and optimize the submap graph,
///                  with a robust kernel on the constraints
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
  const std::optional<SubmapSurfaces>& surfaces_of(int submap) const { return submaps_[static_cast<std::size_t>(submap)].surfaces; }

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
