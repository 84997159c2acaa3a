#include "studies/univariate/univariate_filter.h"

#include <cstddef>

#include "core/particle_weights.h"

namespace patrol::studies {

UnivariateEstimate summarize(const std::vector<double>& states, const std::vector<double>& weights) {
  UnivariateEstimate estimate;
  for (std::size_t i = 0; i < states.size(); ++i) estimate.mean += weights[i] * states[i];
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double offset = states[i] - estimate.mean;
    estimate.variance += weights[i] * offset * offset;
  }
  estimate.effective_sample_size = effective_sample_size(weights);
  return estimate;
}

}  // namespace patrol::studies
