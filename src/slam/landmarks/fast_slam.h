#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "slam/landmarks/association.h"
#include "slam/landmarks/landmark_map.h"
#include "slam/landmarks/landmark_slam.h"
#include "slam/landmarks/odometry_bias.h"
#include "slam/particle_filter_parts.h"

namespace patrol::slam {

struct FastSlamSettings {
  int particles = 10;
  double noise_scale = 1.0;          ///< of odometry's stated deviations: more stands in for what is not modelled
  bool draws_from_observation = false;  ///< FastSLAM 2.0, else 1.0
  OdometryBiasSettings bias{};       ///< learnt by each particle; off by default
  double prior_share = 0.0;          ///< lambda: how much an optimiser minds going far from what odometry says (1: as Bayes would)
  AssociationSettings association{};
};

/// FastSLAM: particles are paths, and on each landmarks are independent, with Kalman filters of their own.
///
///   1.0  draw the increment from odometry, weigh by the observation      Montemerlo, Thrun, Koller, Wegbreit, AAAI 2002
///   2.0  draw it from odometry and the observation together              Montemerlo et al., IJCAI 2003
///   swarms  draw as 1.0, let an optimiser move the increments towards what the observation likes, weigh as 1.0   papers 000, 001
///
/// A particle's position is its increment xi of two coordinates, errors of speed and of turn in standard deviations:
/// pose = move(before, control + diag(std) xi). The observation's part of the fitness is -1/2 sum (nu^T S^-1 nu + log |S|) with the innovation nu
/// (eq. 5 of paper 000 prints no square, and one variance). The weight after a swarm's move is the likelihood alone, as the papers have it:
/// what the move did to the distribution is not undone, and the filter ends overconfident. For 2.0 the weight is exact.
class FastSlam : public LandmarkSlam {
 public:
  /// `motion.std` and `noise` are what the robot believes of its odometry and of its sensor.
  FastSlam(const FastSlamSettings& settings, const ControlMotion& motion, const RangeBearingNoise& noise, ParticleFilterParts parts,
           std::uint64_t seed);

  LandmarkSlamEstimate step(const Control& control, const std::vector<RangeBearing>& seen) override;
  std::vector<std::optional<Eigen::Vector2d>> landmarks() const override;

  /// [particle], as of before the last resampling.
  const std::vector<Pose2>& poses() const { return poses_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  struct Particle {
    Pose2 T_map_body, T_map_before;
    Position increment;
    OdometryBias bias;
    LandmarkMap map;
  };
  /// What 2.0 draws from: normal, in increments.
  struct Proposal {
    Eigen::Vector2d mean;
    Eigen::Matrix2d root;  ///< lower triangular, root root^T is the covariance
    double log_normalizer = 0.0;
  };
  class Step;

  Proposal propose(const Particle& particle, const Control& control, const std::vector<RangeBearing>& seen, const std::vector<int>& matches) const;
  double log_likelihood(const Particle& particle, const Pose2& T_map_body, const std::vector<RangeBearing>& seen,
                        const std::vector<int>& matches) const;
  void reproduce(const Control& control, const std::vector<Offspring>& offspring);
  LandmarkSlamEstimate summary() const;

  FastSlamSettings settings_;
  ControlMotion motion_;
  RangeBearingNoise noise_;
  ParticleFilterParts parts_;
  RandomStream draws_;
  std::uint64_t steps_ = 0;
  std::vector<Particle> particles_;
  std::vector<double> log_weights_;
  std::vector<Pose2> poses_;
  std::vector<double> weights_;
};

}  // namespace patrol::slam
