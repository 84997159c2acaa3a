#include "localize/amcl/range_likelihood.h"

#include <cmath>

namespace patrol::localize {

double range_log_likelihood(double innovation_m, const RangeLikelihoodSettings& settings) {
  const double ratio = innovation_m / settings.range_std_m;
  const double los_probability = 1.0 - settings.nlos_probability - settings.outlier_probability;
  const double nlos =
      innovation_m > 0.0 ? settings.nlos_probability * std::exp(-innovation_m / settings.nlos_bias_m) : 0.0;
  return std::log(los_probability * std::exp(-0.5 * ratio * ratio) + nlos + settings.outlier_probability);
}

double range_innovation_m(const AnchoredRange& range, const Pose2& T_map_body) {
  const Eigen::Vector2d antenna = T_map_body * range.p_body_antenna.head<2>().eval();
  const Eigen::Vector2d across = range.p_map_anchor.head<2>() - antenna;
  const double up = range.p_map_anchor.z() - range.p_body_antenna.z();
  return range.range_m - std::sqrt(across.squaredNorm() + up * up);
}

double ranges_log_likelihood(const std::vector<AnchoredRange>& ranges, const Pose2& T_map_body,
                             const RangeLikelihoodSettings& settings) {
  double sum = 0.0;
  for (const AnchoredRange& range : ranges)
    sum += range_log_likelihood(range_innovation_m(range, T_map_body), settings);
  return sum;
}

double mean_range_likelihood(const std::vector<AnchoredRange>& ranges, const Pose2& T_map_body,
                             const RangeLikelihoodSettings& settings) {
  if (ranges.empty()) return 1.0;
  double sum = 0.0;
  for (const AnchoredRange& range : ranges)
    sum += std::exp(range_log_likelihood(range_innovation_m(range, T_map_body), settings));
  return sum / static_cast<double>(ranges.size());
}

}  // namespace patrol::localize
