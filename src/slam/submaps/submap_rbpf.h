#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/grid.h"
#include "core/pose_graph.h"
#include "slam/graph/pose_graph_solver.h"
#include "slam/graph/scan_tracker.h"
#include "slam/graph/way_uncertainty.h"
#include "slam/submaps/submap_builder.h"
#include "slam/submaps/submap_joiner.h"

namespace patrol::slam {

struct SubmapRbpfSettings {
  ScanTrackerSettings tracking;
  SubmapBuilderSettings submaps;
  SubmapSurfaceSettings surfaces;
  SubmapJoinerSettings joints;
  // How far a submap may lie off where the one before says that it begins.
  double drift_std_m_per_m = 0.003;
  double drift_std_rad_per_m = 0.0005;
  double drift_std_rad_per_rad = 0.005;
  int max_candidates = 8;        ///< for each new submap: the nearest older ones
  double joint_gain = 0.2;       ///< share of a match's points that err independently
  double joint_std_m = 0.02;     ///< of a match's systematic error, however many points it has
  double joint_std_rad = 0.002;
  PoseGraphSolverSettings solver = {.max_iterations = 50, .doubts_loops = true, .loop_kernel = 0.3};  ///< many joints hold each submap: few must be believed
  int min_hits_occupied = 2;
  double min_hit_share_occupied = 0.3;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("tracking", self.tracking);
    visit("submaps", self.submaps);
    visit("surfaces", self.surfaces);
    visit("joints", self.joints);
    visit("drift_std_m_per_m", self.drift_std_m_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_m", self.drift_std_rad_per_m, between(1e-6, 10.0));
    visit("drift_std_rad_per_rad", self.drift_std_rad_per_rad, at_least(0.0));
    visit("max_candidates", self.max_candidates, between(0, 10000));
    visit("joint_gain", self.joint_gain, between(0.0, 1.0));
    visit("joint_std_m", self.joint_std_m, between(1e-5, 1.0));
    visit("joint_std_rad", self.joint_std_rad, between(1e-6, 1.0));
    visit("solver", self.solver);
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_hit_share_occupied", self.min_hit_share_occupied, between(0.0, 1.0));
  }
};

/// Mapping by submaps of a particle filter (paper 002).
///
///   every scan     follow it (scan_tracker.h); the particles of the submap in the making start from there (submap_builder.h)
///   a submap full  its best particle is the submap, and the particles start anew; the older ones that may lie near are compared with it, and those that are
///                  recognised as neighbours are joined to it (submap_joiner.h); solve the graph of submaps, which doubts joints that do not fit
///   the end        draw the scans of all submaps where they lie
///
/// The paper compares when the robot has come home; here a submap is compared when it is full, so that the next is looked for where it should be. Memory: the
/// particles' maps end with their submap, what stays is a list of scans and of surfaces.
class SubmapRbpf {
 public:
  /// `neighbours` recognises neighbouring submaps by their features (pair_features.h).
  /// Throws InputError when a setting breaks its rule.
  SubmapRbpf(const SubmapRbpfSettings& settings, BoostedStumps neighbours, std::uint64_t seed);

  /// Where the body is now, in map.
  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body);
  /// No scan will follow.
  void finish();

  /// [scan]: of every scan that was given, as is believed now.
  std::vector<Pose2> path() const;
  /// Nodes are the submaps.
  const PoseGraph& graph() const { return graph_; }
  std::vector<std::size_t> node_scans() const { return first_scans_; }
  OccupancyGrid map() const;

  /// Two submaps that were compared.
  struct Comparison {
    int target = 0, source = 0;
    PoseGaussian T_target_source;  ///< as was predicted
    JoinResult result;
  };
  const std::vector<Comparison>& comparisons() const { return comparisons_; }
  /// [submap]: the number of its first scan.
  const std::vector<std::size_t>& first_scans() const { return first_scans_; }
  /// [submap that is full]: by what it is compared; none if it saw next to nothing.
  const std::optional<SubmapSurfaces>& surfaces_of(int submap) const { return submaps_[static_cast<std::size_t>(submap)].surfaces; }

 private:
  /// A submap that is full: from now on it is rigid.
  struct Submap {
    std::vector<Keyframe> keyframes;
    std::vector<Pose2> T_submap_body;  ///< [scan]
    std::optional<SubmapSurfaces> surfaces;
  };

  void begin_submap();
  void close_submap();
  void follow_on(const SubmapBuilder& before);
  void join_neighbours(int source);
  std::vector<PoseGaussian> positions_around(int submap) const;
  std::vector<int> candidates_for(int source, const std::vector<PoseGaussian>& around) const;

  SubmapRbpfSettings settings_;
  BoostedStumps neighbours_;
  std::uint64_t seed_;
  ScanTracker tracker_;
  std::optional<SubmapBuilder> builder_;
  std::vector<Submap> submaps_;  ///< full ones
  std::vector<std::size_t> first_scans_;
  std::size_t num_scans_ = 0;
  PoseGraph graph_;  ///< its nodes are the submaps, the one in the making the last
  std::vector<UncertainWay> ways_;
  std::vector<Comparison> comparisons_;
};

}  // namespace patrol::slam
