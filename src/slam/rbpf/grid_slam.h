#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "slam/motion_model.h"
#include "slam/particle_filter_components.h"
#include "slam/range_update.h"
#include "slam/rbpf/grid_slam_settings.h"
#include "slam/rbpf/particle.h"
#include "slam/rbpf/proposal.h"
#include "slam/scan_integration.h"
#include "slam/scan_matcher.h"
#include "slam/slam_update.h"

namespace patrol::slam {

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
/// sources (particle_filter_components.h).
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

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(particles_, best_, keyframes_, T_map_last_, T_odom_last_, T_odom_keyframe_, keyframe_stamp_, new_ranges_,
            ranges_);
  }

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
  Proposal move_by_scan_match(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp,
                              SlamUpdate& update);
  Proposal move_by_odometry(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp,
                            SlamUpdate& update);
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
  std::vector<RangeMeasurement> new_ranges_;  ///< ranges that are not yet gated
  std::vector<RangeMeasurement> ranges_;      ///< ranges accepted since the last keyframe
};

}  // namespace patrol::slam
