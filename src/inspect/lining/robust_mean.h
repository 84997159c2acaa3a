#pragma once

#include <vector>

namespace patrol::inspect {

/// The median, 0 of none; of an even number the upper of the middle two.
double median_of(std::vector<double> values);

/// 1.4826 times the median of the distances from `middle`: of a normal distribution its standard deviation.
double spread_about(const std::vector<double>& values, double middle);

/// Tukey's biweight: 1 at nothing, 0 from `reach` on.
inline double biweight(double residual, double reach) {
  const double ratio = residual / reach;
  return ratio * ratio >= 1.0 ? 0.0 : (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
}
/// In standard deviations: the reach that keeps 95 % of the efficiency of the mean.
inline constexpr double kBiweightReach = 4.685;

struct RobustMean {
  double mean = 0.0;
  double var = 0.0;               ///< of the mean, by the scatter alone
  std::vector<double> weights;    ///< [value], biweight included; sum 1
  int kept = 0;                   ///< values that have any
};

/// A mean with Tukey's biweight about the median: what lies more than 4.7 standard deviations off, and more than `min_reach`, does not count.
RobustMean robust_mean(const std::vector<double>& values, const std::vector<double>& weights, double min_reach);

}  // namespace patrol::inspect
