#pragma once

#include <vector>

namespace patrol::studies {

struct UnivariateEstimate {
  double mean = 0.0;  ///< posterior mean of the state given all observations
  double variance = 0.0;
  double effective_sample_size = 0.0;  ///< effective number of particles; 0 for the exact filter
};

/// Mean and variance of weighted states. `weights` sum to one.
UnivariateEstimate summarize(const std::vector<double>& states, const std::vector<double>& weights);

/// Interface of a filter of a scalar state from observations.
class UnivariateFilter {
 public:
  virtual ~UnivariateFilter() = default;

  /// Predicts one step of the model and updates with its observation.
  virtual UnivariateEstimate step(double observation) = 0;
};

}  // namespace patrol::studies
