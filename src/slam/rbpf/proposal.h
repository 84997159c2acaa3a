#pragma once

#include <optional>

#include <Eigen/Core>

#include "slam/match_points.h"
#include "slam/pose_gaussian.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

/// Proposal distribution of a particle and the resulting weight increment.
struct Proposal {
  PoseGaussian posterior;             ///< pose given odometry, the particle's map and the scan
  double log_weight_increment = 0.0;  ///< increment up to a constant that is equal for all particles
  double inlier_ratio = 0.0;  ///< inlier ratio of the scan (MatchResult); 0: no match, the posterior is the prediction

  /// Samples the posterior; `unit` is a standard normal vector.
  Pose2 sample(const Eigen::Vector3d& unit) const;
};

/// Improved proposal [Grisetti07]: a normal approximation of p(x | m, z, u) around the scan match. The weight increment
/// is the integral of p(z | x, m) p(x | u).
///
/// Deviation from [Grisetti07, eqs. 12-20]: the Gaussian and the integral are not estimated from K samples. They follow
/// from the second derivatives of Gauss-Newton at the match (Laplace's approximation):
///   Sigma^-1 = P^-1 + g H,   log integral = g log p(z | mu) - |mu - prediction|^2_P / 2 + log |Sigma| / 2.
/// The tempering factor `g` (likelihood_tempering) accounts for correlated errors of neighboring beams (surface
/// roughness, tilt). With hundreds of independent beams, only the best particle of the first keyframe would survive.
/// The match itself uses the full information; otherwise the drift of odometry would bias it.
Proposal laplace_proposal(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_start,
                          const PoseGaussian& prediction, double likelihood_tempering,
                          const ScanMatcherSettings& settings);

}  // namespace patrol::slam
