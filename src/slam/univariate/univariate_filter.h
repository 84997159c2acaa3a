#pragma once

#include <vector>

namespace patrol::slam {

struct UnivariateEstimate {
  double mean = 0.0;                   ///< of the state, given all observations so far
  double variance = 0.0;
  double effective_sample_size = 0.0;  ///< of the particles; of the exact filter, which has none, 0
};

/// Of weighted states. `weights` sum to one.
UnivariateEstimate summarize(const std::vector<double>& states, const std::vector<double>& weights);

/// A filter of one coordinate: it sees observations, never the state.
class UnivariateFilter {
 public:
  virtual ~UnivariateFilter() = default;

  /// One step of the model, then its observation.
  virtual UnivariateEstimate step(double observation) = 0;
};

}  // namespace patrol::slam
