#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "slam/motion_model.h"
#include "slam/particle.h"
#include "slam/particle_filter_parts.h"
#include "slam/proposal.h"
#include "slam/range_update.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"
#include "slam/slam_update.h"

namespace patrol::slam {

struct GridSlamSettings {
  // What the map is.
  double resolution_m = 0.05;
  double max_extent_m = 400.0;            ///< nothing is mapped farther than half of this from the origin
  int min_hits_occupied = 2;              ///< fewer hits in a cell are stray, for the published map only
  double min_hit_share_occupied = 0.5;    ///< a smaller share of the beams that came by is something that moved on, likewise
  // When the map is written.
  double keyframe_distance_m = 0.5;
  double keyframe_angle_rad = 0.12;
  double max_tilt_rad = 1.6;              ///< a scan tilted by more is neither matched nor written, as on a ramp between walls that lean
  int initial_keyframes = 25;             ///< so many first scans are all written: the heading of everything after hangs on them
  // What is believed; more particles cost time in proportion.
  int particles = 8;
  double likelihood_gain = 0.2;           ///< share of the points that err independently (proposal.h)
  std::string proposal = "scan_match";    ///< motion: FastSLAM's, drawn from odometry alone
  std::string optimizer = "none";         ///< that moves what was drawn from odometry, with its paper's resampler; for `proposal: motion` alone
  double resample_threshold = 0.5;        ///< resample when the effective sample size falls below this share of the particles
  MotionModelSettings motion;
  RangeUpdateSettings ranges;
  ScanMatcherSettings matching;
  ScanIntegrationSettings integration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("resolution_m", self.resolution_m, between(0.01, 1.0));
    visit("max_extent_m", self.max_extent_m, between(1.0, 5000.0));
    visit("min_hits_occupied", self.min_hits_occupied, between(1, 1000));
    visit("min_hit_share_occupied", self.min_hit_share_occupied, between(0.0, 1.0));
    visit("keyframe_distance_m", self.keyframe_distance_m, between(0.0, 10.0));
    visit("keyframe_angle_rad", self.keyframe_angle_rad, between(0.0, 3.2));
    visit("max_tilt_rad", self.max_tilt_rad, between(0.0, 1.6));
    visit("initial_keyframes", self.initial_keyframes, between(1, 1000));
    visit("particles", self.particles, between(1, 10000));
    visit("likelihood_gain", self.likelihood_gain, between(0.0, 1.0));
    visit("proposal", self.proposal, one_of({"scan_match", "motion"}));
    visit("optimizer", self.optimizer, one_of(optimizers()));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
    visit("motion", self.motion);
    visit("ranges", self.ranges);
    visit("matching", self.matching);
    visit("integration", self.integration);
  }
};

/// Grid mapping with a Rao-Blackwellised particle filter and improved proposals (Grisetti, Stachniss, Burgard 2007).
///
///   every scan     odometry -> match against the best particle's map -> pose; tilted far, odometry alone
///   ranges         judged by the best particle's prediction; part of every particle's, until the next keyframe has used them
///   a keyframe     each particle: predict, match on its own map, draw, weigh -> resample -> write the scan into each map
///
/// Departures from Gmapping, and why. Every scan is matched, but only keyframes are written and weighed: the pose is
/// always fresh, and the cost of the particles is paid twice a metre. Matching is to lines through the cells' mean hits
/// (scan_matcher.h), the proposal is Laplace's (proposal.h). No separate rejection of moving things: a cell known to be
/// free is believed to be surface only after many hits (GridCell), so a walker never becomes something to match with.
///
/// With `proposal: motion` it is FastSLAM on grids as papers 000 and 001 start from: particles are drawn from odometry and weighed by the scan, an
/// optimiser may move them in between, and ISCSO and IFA resample as their papers say (grid_step.h).
class GridSlam {
 public:
  /// Throws InputError if a setting breaks its rule. `T_map_start` is where the first scan is taken.
  GridSlam(const GridSlamSettings& settings, std::uint64_t seed, const Pose2& T_map_start = {});

  /// A UWB range of before the next scan. It holds the particles where the scans leave a direction open, as along a lined tunnel;
  /// one that went round a corner is left out.
  void add(const RangeSighting& sighting) { new_ranges_.push_back(sighting); }

  /// `T_odom_body` at the scan's stamp.
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body);

  /// Of the best particle.
  OccupancyGrid map() const;
  const GridMap& best_map() const { return particles_[best_].map; }
  /// [keyframe]: the way that the best particle has come.
  std::vector<Pose2> best_path() const;
  /// As of the last keyframe.
  ParticleSet particles() const;

 private:
  /// Where a particle should be by odometry and ranges, and how probable those ranges are there.
  struct Prediction {
    PoseGaussian pose;
    double log_density = 0.0;
  };

  void accept_ranges(const Pose2& T_odom_body, Time stamp);
  Proposal track(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp) const;
  bool is_keyframe_due(const Pose2& T_map_body) const;
  std::vector<Proposal> propose(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp) const;
  void move_particles(const std::vector<Proposal>& proposals);
  Proposal move_by_scan_match(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp, SlamUpdate& update);
  Proposal move_by_odometry(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp, SlamUpdate& update);
  double choose_best();
  bool resample_if_needed(double num_effective);
  void integrate(const LevelScan& scan);
  Prediction predict(const Particle& particle, const Pose2& T_odom_body, Time stamp) const;

  GridSlamSettings settings_;
  ParticleFilterParts parts_;  ///< of what is drawn from odometry
  RandomStream proposal_noise_, resampling_noise_;
  std::vector<Particle> particles_;  ///< one until the start is mapped, then as many as asked
  std::size_t best_ = 0;             ///< the particle of the largest weight
  std::uint64_t keyframes_ = 0;      ///< so far

  Pose2 T_map_last_;       ///< the estimate at the newest scan
  Pose2 T_odom_last_;      ///< odometry at the newest scan
  Pose2 T_odom_keyframe_;  ///< odometry at the last keyframe
  Time keyframe_stamp_{};
  std::vector<RangeSighting> new_ranges_;  ///< not yet judged
  std::vector<RangeSighting> ranges_;      ///< accepted since the last keyframe
};

}  // namespace patrol::slam
