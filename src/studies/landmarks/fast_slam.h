#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/particle_filter_components.h"
#include "studies/landmarks/association.h"
#include "studies/landmarks/landmark_map.h"
#include "studies/landmarks/landmark_slam.h"
#include "studies/landmarks/odometry_bias.h"

namespace patrol::studies {

struct FastSlamSettings {
  int particles = 10;
  /// Scale factor of the stated standard deviations of odometry; larger values cover unmodeled errors.
  double noise_scale = 1.0;
  bool use_optimal_proposal = false;  ///< true: FastSLAM 2.0; false: 1.0
  OdometryBiasSettings bias{};        ///< bias estimated by each particle; off by default
  double prior_weight = 0.0;          ///< lambda: weight of the odometry prior in the optimizer's fitness (1: Bayesian)
  AssociationSettings association{};
};

/// FastSLAM: each particle is a trajectory with independent landmarks, each estimated by a Kalman filter.
///
///   1.0     sample the increment from odometry, weight with the observation [Montemerlo02]
///   2.0     sample the increment given odometry and observation [Montemerlo03]
///   swarms  sample as in 1.0, optimize the increments by the observation, weight as in 1.0 [Wu25], [Cui21]
///
/// A particle's position is its increment xi of two coordinates, the errors of speed and turn in standard deviations:
/// pose = move(before, control + diag(std) xi). The fitness by the observation is -1/2 sum (nu^T S^-1 nu + log |S|)
/// with the innovation nu.
///
/// Interpretation of [Wu25]: eq. 5 prints no square and a single variance.
/// As in the sources, the weight after a swarm's move is the likelihood alone. It does not correct for the changed
/// sampling distribution, so the filter is overconfident. For 2.0 the weight is exact.
class FastSlam : public LandmarkSlam {
 public:
  /// `motion.std` and `noise` are the assumed noise of odometry and sensor.
  FastSlam(const FastSlamSettings& settings, ControlMotion motion, const RangeBearingNoise& noise,
           slam::ParticleFilterComponents components, std::uint64_t seed);

  LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& observations) override;
  std::vector<std::optional<Eigen::Vector2d>> landmarks() const override;

  /// Particles before the last resampling, [particle].
  const std::vector<Pose2>& poses() const { return poses_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  struct Particle {
    Pose2 T_map_body, T_map_before;
    slam::Position increment;
    OdometryBias bias;
    LandmarkMap map;
  };
  /// Normal proposal distribution of FastSLAM 2.0, in increments.
  struct Proposal {
    Eigen::Vector2d mean;
    Eigen::Matrix2d root;  ///< lower triangular; root root^T is the covariance
    double log_normalizer = 0.0;
  };
  class Step;

  Proposal propose(const Particle& particle, const Control& control, const std::vector<RangeBearing>& observations,
                   const std::vector<int>& matches) const;
  double log_likelihood(const Particle& particle, const Pose2& T_map_body,
                        const std::vector<RangeBearing>& observations, const std::vector<int>& matches) const;
  void apply_resampling(const Control& control, const std::vector<slam::Offspring>& offspring);
  LandmarkSlamEstimate summary() const;

  FastSlamSettings settings_;
  ControlMotion motion_;
  RangeBearingNoise noise_;
  slam::ParticleFilterComponents components_;
  RandomStream random_;
  std::uint64_t steps_ = 0;
  std::vector<Particle> particles_;
  std::vector<double> log_weights_;
  std::vector<Pose2> poses_;
  std::vector<double> weights_;
};

}  // namespace patrol::studies
