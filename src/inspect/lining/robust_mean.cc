#include "inspect/lining/robust_mean.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patrol::inspect {

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double mad_std(const std::vector<double>& values, double middle) {
  std::vector<double> distances;
  distances.reserve(values.size());
  for (const double value : values) distances.push_back(std::abs(value - middle));
  return 1.4826 * median_of(std::move(distances));
}

RobustMean robust_mean(const std::vector<double>& values, const std::vector<double>& weights, double min_cutoff) {
  RobustMean result{.mean = median_of(values), .weights = std::vector<double>(values.size(), 0.0)};
  const double cutoff = std::max(min_cutoff, kBiweightCutoff * mad_std(values, result.mean));
  for (int iteration = 0; iteration < 10; ++iteration) {
    double sum = 0.0, moment = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      result.weights[i] = weights[i] * biweight(values[i] - result.mean, cutoff);
      sum += result.weights[i];
      moment += result.weights[i] * values[i];
    }
    if (!(sum > 0.0)) return result;
    for (double& weight : result.weights) weight /= sum;
    const double before = result.mean;
    result.mean = moment / sum;
    if (std::abs(result.mean - before) < 1e-7) break;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double part = result.weights[i] * (values[i] - result.mean);
    result.var += part * part;
    result.kept += result.weights[i] > 0.0 ? 1 : 0;
  }
  if (result.kept > 1) result.var *= static_cast<double>(result.kept) / (result.kept - 1);
  return result;
}

}  // namespace patrol::inspect
