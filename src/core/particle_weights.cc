#include "core/particle_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace patrol {

std::vector<double> normalized_weights(const std::vector<double>& log_weights) {
  if (log_weights.empty()) return {};
  const double largest = *std::max_element(log_weights.begin(), log_weights.end());
  std::vector<double> weights(log_weights.size());
  std::transform(log_weights.begin(), log_weights.end(), weights.begin(),
                 [&](double log_weight) { return std::exp(log_weight - largest); });
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return weights;
}

double effective_sample_size(const std::vector<double>& weights) {
  return 1.0 / std::inner_product(weights.begin(), weights.end(), weights.begin(), 0.0);
}

std::vector<std::size_t> systematic_parents(const std::vector<double>& weights, double uniform) {
  return systematic_parents(weights, uniform, weights.size());
}

std::vector<std::size_t> systematic_parents(const std::vector<double>& weights, double uniform,
                                            std::size_t num_children) {
  std::vector<std::size_t> parents(num_children);
  const double spacing = 1.0 / static_cast<double>(num_children);
  std::size_t parent = 0;
  double cumulative = weights.front();
  for (std::size_t child = 0; child < num_children; ++child) {
    const double pointer = (static_cast<double>(child) + uniform) * spacing;
    while (pointer > cumulative && parent + 1 < weights.size()) cumulative += weights[++parent];
    parents[child] = parent;
  }
  return parents;
}

}  // namespace patrol
