#pragma once

#include <vector>

namespace patrol::inspect {

/// Returns the median; 0 for no values, the upper of the two middle values for an even number.
double median_of(std::vector<double> values);

/// Returns 1.4826 times the median absolute deviation from `middle`: the standard deviation for a normal distribution.
double mad_std(const std::vector<double>& values, double middle);

/// Returns the weight of Tukey's biweight: 1 at zero, 0 from `cutoff` on.
inline double biweight(double residual, double cutoff) {
  const double ratio = residual / cutoff;
  return ratio * ratio >= 1.0 ? 0.0 : (1.0 - ratio * ratio) * (1.0 - ratio * ratio);
}
/// Cutoff in standard deviations for 95 % efficiency relative to the mean.
inline constexpr double kBiweightCutoff = 4.685;

struct RobustMean {
  double mean = 0.0;
  double var = 0.0;             ///< variance of the mean, from the scatter
  std::vector<double> weights;  ///< [value], including the biweight; normalized to sum 1
  int kept = 0;                 ///< number of values with positive weight
};

/// Returns the mean with Tukey's biweight around the median. Values are excluded if they deviate by more than 4.7
/// standard deviations and by more than `min_cutoff`.
RobustMean robust_mean(const std::vector<double>& values, const std::vector<double>& weights, double min_cutoff);

}  // namespace patrol::inspect
