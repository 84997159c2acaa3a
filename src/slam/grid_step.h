#pragma once

#include <Eigen/Core>

#include <vector>

#include "slam/match_points.h"
#include "slam/particle.h"
#include "slam/pose_gaussian.h"
#include "slam/resampler.h"
#include "slam/scan_matcher.h"
#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Grid mapping's particles at one keyframe, as a particle filter sees them (ParticleProblem): FastSLAM on grids, and its swarms (paper 000). A position is
/// the whitened error of odometry since the last keyframe, pose = prediction + L xi with L L^T the prediction's covariance; each particle judges it by
/// the scan on its own map.
class GridStep {
 public:
  /// `predictions` [particle]. `particles`, `points` and `settings` must outlive this.
  GridStep(std::vector<Particle>& particles, std::vector<PoseGaussian> predictions, const std::vector<MatchPoint>& points, double likelihood_gain,
           const ScanMatcherSettings& settings);

  std::size_t size() const { return particles_.size(); }
  Position draw(std::size_t particle, RandomSequence& random) const;
  double log_fitness(std::size_t particle, const Position& position) const;
  double settle(std::size_t particle, const Position& position);
  /// A particle that is drawn towards another takes its map, and a share of its increment.
  void reproduce(const std::vector<Offspring>& offspring);

 private:
  Pose2 pose_at(std::size_t particle, const Position& position) const { return shifted(predictions_[particle].mean, roots_[particle] * position); }

  std::vector<Particle>& particles_;
  std::vector<PoseGaussian> predictions_;
  std::vector<Eigen::Matrix3d> roots_;
  const std::vector<MatchPoint>& points_;
  double likelihood_gain_;
  const ScanMatcherSettings& settings_;
  std::vector<Position> positions_;  ///< [particle], where it settled
};

}  // namespace patrol::slam
