#include "slam/proposal.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <cmath>

#include "core/linear_algebra.h"

namespace patrol::slam {

Pose2 Proposal::sample(const Eigen::Vector3d& unit) const {
  const Eigen::Matrix3d L = cholesky_factor(posterior.covariance);
  return shifted(posterior.mean, L * unit);
}

Proposal propose_from_scan(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_start,
                           const PoseGaussian& prediction, double likelihood_gain, const ScanMatcherSettings& settings) {
  const std::optional<MatchResult> match = match_scan(map, points, T_map_start, prediction, settings);
  if (!match) return {.posterior = prediction};

  const Eigen::Matrix3d P_inverse = prediction.covariance.inverse();
  const Eigen::Matrix3d Sigma = (P_inverse + likelihood_gain * match->information).inverse();
  const Eigen::Vector3d offset = prediction.offset_of(match->T_map_body);
  return {.posterior = {.mean = match->T_map_body, .covariance = 0.5 * (Sigma + Sigma.transpose())},
          .log_weight_change = likelihood_gain * match->log_likelihood - 0.5 * offset.dot(P_inverse * offset) +
                               0.5 * std::log(Sigma.determinant()),
          .matched_share = match->matched_share};
}

}  // namespace patrol::slam
