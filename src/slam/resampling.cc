#include "slam/resampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/particle_weights.h"

namespace patrol::slam {
namespace {

/// Relative rounding tolerance of stepwise resampling: particles of equal weight all survive.
constexpr double kRounding = 1e-12;

std::size_t sample_index(const std::vector<double>& weights, double uniform) {
  double cumulative = 0.0;
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
    cumulative += weights[i];
    if (uniform * total < cumulative) return i;
  }
  return weights.size() - 1;
}

std::vector<std::size_t> order_by_descending_weight(const std::vector<double>& weights) {
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
  return order;
}

}  // namespace

std::vector<Offspring> resample_multinomial(const std::vector<double>& weights, RandomSequence& random) {
  std::vector<Offspring> children;
  for (std::size_t i = 0; i < weights.size(); ++i)
    children.push_back({.parent = sample_index(weights, random.uniform())});
  return children;
}

std::vector<Offspring> resample_systematic(const std::vector<double>& weights, RandomSequence& random) {
  std::vector<Offspring> children;
  for (const std::size_t parent : systematic_parents(weights, random.uniform())) children.push_back({.parent = parent});
  return children;
}

std::vector<Offspring> resample_residual(const std::vector<double>& weights, RandomSequence& random) {
  std::vector<Offspring> children;
  std::vector<double> rests;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = weights[i] * static_cast<double>(weights.size());
    for (int copies = static_cast<int>(expected); copies > 0 && children.size() < weights.size(); --copies)
      children.push_back({.parent = i});
    rests.push_back(expected - std::floor(expected));
  }
  while (children.size() < weights.size()) children.push_back({.parent = sample_index(rests, random.uniform())});
  return children;
}

std::vector<Offspring> optimize_low_weights(const std::vector<double>& weights, RandomSequence& random) {
  const double num_effective = effective_sample_size(weights);
  const auto num_high =
      static_cast<std::size_t>(std::clamp(std::ceil(num_effective) - 1.0, 1.0, static_cast<double>(weights.size())));
  const std::vector<std::size_t> order = order_by_descending_weight(weights);
  std::vector<Offspring> children;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    Offspring child{.parent = order[rank]};
    if (rank >= num_high) {
      child.attractor = order[random.index(num_high)];
      child.attraction = random.uniform();
    }
    children.push_back(child);
  }
  return children;
}

std::vector<Offspring> resample_stepwise(const std::vector<double>& weights, RandomSequence& random,
                                         const StepwiseResampling& settings) {
  const std::vector<std::size_t> order = order_by_descending_weight(weights);
  double average = 0.0, power = 1.0, sum = 0.0;
  for (const std::size_t i : order) {
    average = settings.averaging * average + (1.0 - settings.averaging) * weights[i];
    power *= settings.averaging;
    sum += average / (1.0 - power);
  }
  const double delta = sum / static_cast<double>(weights.size()) * (1.0 - kRounding);
  std::vector<std::size_t> survivors;
  std::vector<Offspring> children;
  for (const std::size_t i : order) {
    if (!(weights[i] >= delta)) break;
    survivors.push_back(i);
    for (int copies = static_cast<int>(std::ceil(weights[i] / delta - 2.0 * kRounding));
         copies > 0 && children.size() < weights.size(); --copies) {
      children.push_back({.parent = i});
    }
  }
  if (survivors.empty()) survivors.push_back(order.front());
  for (std::size_t i = 0; children.size() < weights.size(); ++i) {
    children.push_back(
        {.parent = survivors[i % survivors.size()], .mutation = settings.mutation_std * random.normal()});
  }
  return children;
}

}  // namespace patrol::slam
