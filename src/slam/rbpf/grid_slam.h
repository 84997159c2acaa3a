#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "slam/motion_model.h"
#include "slam/rbpf/particle.h"
#include "slam/particle_filter_components.h"
#include "slam/rbpf/proposal.h"
#include "slam/range_update.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"
#include "slam/slam_update.h"

namespace patrol::slam {

struct GridSlamSettings {
  // Map representation.
  double resolution_m = 0.05;
  double max_extent_m = 400.0;            ///< side of the mapped square around the origin
  int min_hits_occupied = 2;              ///< published map only: cells with fewer hits are treated as outliers
  /// Published map only: minimum ratio of hits to hits plus passes; below it the cell was occupied by a moving object.
  double min_occupied_hit_ratio = 0.5;
  // Map updates.
  double keyframe_distance_m = 0.5;
  double keyframe_angle_rad = 0.12;
  /// Scans tilted by more are neither matched nor integrated, for example on a ramp between inclined walls.
  double max_tilt_rad = 1.6;
  int initial_keyframes = 25;  ///< the first N scans are all keyframes, because the map heading depends on them
  // Filter; the cost is proportional to the number of particles.
  int particles = 8;
  double likelihood_tempering = 0.2;  ///< tempering factor: fraction of the points with independent errors (proposal.h)
  std::string proposal = "scan_match";    ///< scan_match; or motion: sample from odometry only, as in FastSLAM
  /// Optimizer applied to the odometry samples, with the resampler of its source; only with `proposal: motion`.
  std::string optimizer = "none";
  /// Resample if the effective sample size is below this fraction of the number of particles.
  double resample_threshold = 0.5;
  MotionModelSettings motion;
  RangeUpdateSettings ranges;
  ScanMatcherSettings matching;
  ScanIntegrationSettings integration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("max_extent_m", self.max_extent_m, between(1.0, 5000.0));
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_occupied_hit_ratio", self.min_occupied_hit_ratio, between(0.0, 1.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.0, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.0, 3.2));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("initial_keyframes", self.initial_keyframes, between(1, 1000));
    visit("particles", self.particles, between(1, 10000));
    visit("likelihood_tempering", self.likelihood_tempering, between(0.0, 1.0));
    visit("proposal", self.proposal, one_of({"scan_match", "motion"}));
    visit("optimizer", self.optimizer, one_of(optimizers()));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
    visit("motion", self.motion);
    visit("ranges", self.ranges);
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

/// Grid mapping with a Rao-Blackwellized particle filter and improved proposals [Grisetti07].
///
///   every scan     odometry -> match against the best particle's map -> pose; odometry only if the tilt is too large
///   range          gated with the best particle's prediction; used by every particle until the next keyframe
///   keyframe       each particle: predict, match on its own map, sample, weight -> resample -> integrate the scan
///
/// Deviations from Gmapping:
/// - Every scan is matched, but only keyframes are integrated and weighted. The pose is always current, and the cost of
///   the particles arises only twice per meter.
/// - Scans are matched to lines through the mean hits of the cells (scan_matcher.h); the proposal uses Laplace's
///   approximation (proposal.h).
/// - Dynamic obstacles are not rejected separately. A cell observed as free becomes a surface only after many hits
///   (GridCell), so pedestrians do not become part of the surface.
///
/// With `proposal: motion` it is FastSLAM on grids, the baseline of [Wu25] and [Cui21]: particles are sampled from
/// odometry and weighted by the scan. An optimizer may move them in between; ISCSO and IFA use the resamplers of their
/// sources (grid_step.h).
class GridSlam {
 public:
  /// Throws InputError if a setting is invalid. `T_map_start` is the pose of the first scan.
  GridSlam(const GridSlamSettings& settings, std::uint64_t seed, const Pose2& T_map_start = {});

  /// Adds a UWB range measured before the next scan. Ranges constrain the particles along directions that scans leave
  /// degenerate, for example along a lined tunnel. NLOS ranges are rejected by the gate.
  void add(const RangeMeasurement& measurement) { new_ranges_.push_back(measurement); }

  /// Processes a scan; `T_odom_body` is the odometry at its stamp.
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);

  /// Map of the best particle.
  OccupancyGrid map() const;
  const GridMap& best_map() const { return particles_[best_].map; }
  /// Trajectory of the best particle, [keyframe].
  std::vector<Pose2> best_path() const;
  /// Particles at the last keyframe.
  ParticleSet particles() const;

 private:
  /// Pose predicted by odometry and ranges, and the log probability density of the ranges.
  struct Prediction {
    PoseGaussian pose;
    double log_density = 0.0;
  };

  void gate_ranges(const Pose2& T_odom_body, Time stamp);
  Proposal track(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp) const;
  bool is_keyframe_due(const Pose2& T_map_body) const;
  std::vector<Proposal> propose(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp) const;
  void sample_particles(const std::vector<Proposal>& proposals);
  Proposal move_by_scan_match(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp, SlamUpdate& update);
  Proposal move_by_odometry(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp, SlamUpdate& update);
  double choose_best();
  bool resample_if_needed(double num_effective);
  void integrate(const LevelScan& scan);
  Prediction predict(const Particle& particle, const Pose2& T_odom_body, Time stamp) const;

  GridSlamSettings settings_;
  ParticleFilterComponents components_;  ///< components for particles sampled from odometry
  RandomStream proposal_noise_, resampling_noise_;
  std::vector<Particle> particles_;  ///< one until the initial keyframes are mapped, then `settings.particles`
  std::size_t best_ = 0;             ///< index of the particle with the largest weight
  std::uint64_t keyframes_ = 0;      ///< number of keyframes

  Pose2 T_map_last_;       ///< estimate at the newest scan
  Pose2 T_odom_last_;      ///< odometry at the newest scan
  Pose2 T_odom_keyframe_;  ///< odometry at the last keyframe
  Time keyframe_stamp_{};
  std::vector<RangeMeasurement> new_ranges_;  ///< not yet gated
  std::vector<RangeMeasurement> ranges_;      ///< accepted since the last keyframe
};

}  // namespace patrol::slam
