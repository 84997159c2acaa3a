#pragma once

#include <Eigen/Core>

#include <optional>

#include "slam/match_points.h"
#include "slam/pose_gaussian.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

/// Where a particle goes, and what that does to its weight.
struct Proposal {
  PoseGaussian posterior;          ///< the pose given odometry, the particle's map and the scan
  double log_weight_change = 0.0;  ///< up to a constant that all particles share
  double matched_share = 0.0;      ///< of the scan (MatchResult); 0: no match, the posterior is the prediction

  /// A draw from the posterior; `unit` is standard normal.
  Pose2 sample(const Eigen::Vector3d& unit) const;
};

/// Grisetti, Stachniss, Burgard, "Improved techniques for grid mapping with Rao-Blackwellized particle filters", IEEE
/// T-RO 2007: draw from p(x | m, z, u), normally distributed around the scan match, and weight with the integral of
/// p(z | x, m) p(x | u).
///
/// There the Gaussian and the integral come from K samples around the match (equations 12-20). Here both come from the
/// second derivatives at the match (Laplace's approximation), which Gauss-Newton leaves behind:
///   Sigma^-1 = P^-1 + g H,   log integral = g log p(z | mu) - |mu - prediction|^2_P / 2 + log |Sigma| / 2.
/// `g` (likelihood_gain) undoes that neighbouring beams err together (roughness of the surface, tilt): taken as
/// independent, hundreds of beams would make the first keyframe's best particle the only one. The match itself uses
/// the full information, or odometry's drift would drag it.
Proposal propose_from_scan(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_start,
                           const PoseGaussian& prediction, double likelihood_gain, const ScanMatcherSettings& settings);

}  // namespace patrol::slam
