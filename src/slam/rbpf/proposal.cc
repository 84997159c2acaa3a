#include "slam/rbpf/proposal.h"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/geometry/linear_algebra.h"

namespace patrol::slam {

Pose2 Proposal::sample(const Eigen::Vector3d& unit) const {
  const Eigen::Matrix3d L = cholesky_factor(posterior.covariance);
  return perturbed(posterior.mean, L * unit);
}

Proposal laplace_proposal(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_start,
                          const PoseGaussian& prediction, double likelihood_tempering,
                          const ScanMatcherSettings& settings) {
  const std::optional<MatchResult> match = match_scan(map, points, T_map_start, prediction, settings);
  if (!match) return {.posterior = prediction};

  const Eigen::Matrix3d P_inverse = prediction.covariance.inverse();
  const Eigen::Matrix3d Sigma = (P_inverse + likelihood_tempering * match->information).inverse();
  const Eigen::Vector3d offset = prediction.residual_to_mean(match->T_map_body);
  return {.posterior = {.mean = match->T_map_body, .covariance = 0.5 * (Sigma + Sigma.transpose())},
          .log_weight_increment = likelihood_tempering * match->log_likelihood - 0.5 * offset.dot(P_inverse * offset) +
                                  0.5 * std::log(Sigma.determinant()),
          .inlier_ratio = match->inlier_ratio};
}

}  // namespace patrol::slam
