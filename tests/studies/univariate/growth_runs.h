#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "studies/univariate/growth_model.h"
#include "studies/univariate/univariate_filter.h"

namespace patrol::studies {

inline std::vector<UnivariateEstimate> filter_all(UnivariateFilter& filter, const std::vector<double>& observations) {
  std::vector<UnivariateEstimate> estimates;
  for (const double observation : observations) estimates.push_back(filter.step(observation));
  return estimates;
}

inline std::vector<double> means_of(const std::vector<UnivariateEstimate>& estimates) {
  std::vector<double> means;
  for (const UnivariateEstimate& estimate : estimates) means.push_back(estimate.mean);
  return means;
}

/// Root mean square of the differences, term by term.
inline double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// A filter for the run of that seed. An honest one makes no use of `run`.
using FilterMaker = std::function<std::unique_ptr<UnivariateFilter>(std::uint64_t seed, const GrowthRun& run)>;

/// [seed - 1] of seeds 1 ... `seeds`: the root mean square error over each run of `model`.
inline std::vector<double> errors_of(const FilterMaker& make, const GrowthModel& model, std::size_t seeds) {
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const GrowthRun run = model.simulate(seed);
    errors.push_back(rms_difference(means_of(filter_all(*make(seed, run), run.observations)), run.states));
  }
  return errors;
}

struct MeanInterval {
  double mean = 0.0, low = 0.0, high = 0.0;  ///< mean and normal 95 % confidence interval
};

/// Mean and interval of the paired differences a - b.
inline MeanInterval paired_difference(const std::vector<double>& a, const std::vector<double>& b) {
  const auto num = static_cast<double>(a.size());
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) mean += (a[i] - b[i]) / num;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i] - mean) * (a[i] - b[i] - mean);
  const double half_width = 1.96 * std::sqrt(squares / (num - 1.0) / num);
  return {.mean = mean, .low = mean - half_width, .high = mean + half_width};
}

}  // namespace patrol::studies
