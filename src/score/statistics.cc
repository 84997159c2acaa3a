#include "score/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace patrol::score {
namespace {

/// Two-sided quantile of Student's t: the probability of the interval between minus and plus the result is `level`.
double student_t(std::size_t degrees_of_freedom, double level) {
  const boost::math::students_t distribution(static_cast<double>(degrees_of_freedom));
  return boost::math::quantile(boost::math::complement(distribution, (1.0 - level) / 2.0));
}

/// Ranks from 1, [value]; equal values have the mean of their ranks.
std::vector<double> to_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t end = first;
    while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
    for (std::size_t i = first; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(first + 1 + end);
    first = end;
  }
  return ranks;
}

bool has_nan(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return std::isnan(value); });
}

}  // namespace

double mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double variance(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double center = mean(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - center) * (value - center);
  return sum / static_cast<double>(values.size() - 1);
}

double root_mean_square(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double maximum(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const double rank = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

std::optional<Interval> mean_interval(const std::vector<double>& values, double level) {
  if (values.size() < 2) return std::nullopt;
  const double center = mean(values);
  const double half =
      student_t(values.size() - 1, level) * std::sqrt(variance(values) / static_cast<double>(values.size()));
  return Interval{.center = center, .low = center - half, .high = center + half};
}

std::optional<double> mean_p_value(const std::vector<double>& values) {
  if (values.size() < 2) return std::nullopt;
  const double center = mean(values), std_error = std::sqrt(variance(values) / static_cast<double>(values.size()));
  if (std_error == 0.0) return center == 0.0 ? 1.0 : 0.0;
  const boost::math::students_t distribution(static_cast<double>(values.size() - 1));
  return 2.0 * boost::math::cdf(boost::math::complement(distribution, std::abs(center) / std_error));
}

std::vector<double> holm_adjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    largest = std::max(largest, std::min(1.0, static_cast<double>(order.size() - i) * p_values[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

void adjust_by_holm(const std::vector<std::optional<double>*>& p_values) {
  std::vector<double> present;
  for (const std::optional<double>* p_value : p_values) {
    if (*p_value) present.push_back(**p_value);
  }
  const std::vector<double> adjusted = holm_adjusted(present);
  auto next = adjusted.begin();
  for (std::optional<double>* p_value : p_values) {
    if (*p_value) *p_value = *next++;
  }
}

double sign_test_p_value(int num_first, int num_second) {
  const int num_tosses = num_first + num_second;
  if (num_tosses == 0) return 1.0;
  const boost::math::binomial distribution(num_tosses, 0.5);
  return std::min(1.0, 2.0 * boost::math::cdf(distribution, std::min(num_first, num_second)));
}

std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  if (has_nan(a) || has_nan(b)) return std::nullopt;
  const std::vector<double> ranks_a = to_ranks(a), ranks_b = to_ranks(b);
  const double spread = std::sqrt(variance(ranks_a) * variance(ranks_b));
  if (!(spread > 0.0)) return std::nullopt;
  const double mean_a = mean(ranks_a), mean_b = mean(ranks_b);
  double covariance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) covariance += (ranks_a[i] - mean_a) * (ranks_b[i] - mean_b);
  return covariance / static_cast<double>(a.size() - 1) / spread;
}

std::optional<double> roc_auc(const std::vector<double>& values, const std::vector<bool>& is_marked) {
  if (has_nan(values)) return std::nullopt;
  const std::vector<double> ranks = to_ranks(values);
  double sum = 0.0, num_marked = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_marked[i]) continue;
    sum += ranks[i];
    num_marked += 1.0;
  }
  const double num_others = static_cast<double>(values.size()) - num_marked;
  if (num_marked == 0.0 || num_others == 0.0) return std::nullopt;
  return (sum - 0.5 * num_marked * (num_marked + 1.0)) / (num_marked * num_others);
}

}  // namespace patrol::score
