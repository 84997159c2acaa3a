#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/match_points.h"
#include "slam/pose_gaussian.h"
#include "slam/rbpf/particle.h"
#include "slam/resampling.h"
#include "slam/scan_matcher.h"
#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Particles of grid mapping at one keyframe, as a ParticleProblem: FastSLAM on grids with swarm optimization [Wu25]. A
/// position is the whitened odometry error xi since the last keyframe: pose = prediction + L xi, with L L^T the
/// covariance of the prediction. The fitness of a position is the likelihood of the scan on the particle's own map.
class RbpfParticleProblem {
 public:
  /// `predictions` [particle]. `particles`, `points` and `settings` must outlive this object.
  RbpfParticleProblem(std::vector<Particle>& particles, std::vector<PoseGaussian> predictions,
                      const std::vector<MatchPoint>& points, double likelihood_tempering,
                      const ScanMatcherSettings& settings);

  std::size_t size() const { return particles_.size(); }
  static Position sample(std::size_t particle, RandomSequence& random);
  double log_fitness(std::size_t particle, const Position& position) const;
  double commit(std::size_t particle, const Position& position);
  /// Replaces the particles by their offspring. A particle that is attracted toward another one takes the other's map
  /// and a fraction of its increment.
  void apply_resampling(const std::vector<Offspring>& offspring);

 private:
  Pose2 pose_at(std::size_t particle, const Position& position) const {
    return perturbed(predictions_[particle].mean, roots_[particle] * position);
  }

  std::vector<Particle>& particles_;
  std::vector<PoseGaussian> predictions_;
  std::vector<Eigen::Matrix3d> roots_;
  const std::vector<MatchPoint>& points_;
  double likelihood_tempering_;
  const ScanMatcherSettings& settings_;
  std::vector<Position> positions_;  ///< [particle], final position of each particle
};

}  // namespace patrol::slam
