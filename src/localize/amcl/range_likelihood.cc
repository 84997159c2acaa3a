#include "localize/amcl/range_likelihood.h"

#include <cmath>

namespace patrol::localize {

double range_log_likelihood(double excess_m, const RangeLikelihoodSettings& settings) {
  const double ratio = excess_m / settings.range_std_m;
  const double plain_share = 1.0 - settings.blocked_share - settings.outlier_share;
  const double blocked = excess_m > 0.0 ? settings.blocked_share * std::exp(-excess_m / settings.blocked_excess_m) : 0.0;
  return std::log(plain_share * std::exp(-0.5 * ratio * ratio) + blocked + settings.outlier_share);
}

double range_excess_m(const AnchoredRange& range, const Pose2& T_map_body) {
  const Eigen::Vector2d antenna = T_map_body * range.p_body_antenna.head<2>().eval();
  const Eigen::Vector2d across = range.p_map_anchor.head<2>() - antenna;
  const double up = range.p_map_anchor.z() - range.p_body_antenna.z();
  return range.range_m - std::sqrt(across.squaredNorm() + up * up);
}

}  // namespace patrol::localize
