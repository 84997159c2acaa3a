#include "score/statistics.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace patrol::score {
namespace {

/// Two-sided quantile of Student's t: the share `level` lies within plus and minus it.
double student_t(std::size_t degrees_of_freedom, double level) {
  const boost::math::students_t distribution(static_cast<double>(degrees_of_freedom));
  return boost::math::quantile(boost::math::complement(distribution, (1.0 - level) / 2.0));
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

double confidence_95(const std::vector<double>& values) {
  const std::optional<Interval> interval = mean_interval(values);
  return interval ? interval->center - interval->low : 0.0;
}

std::optional<Interval> mean_interval(const std::vector<double>& values, double level) {
  if (values.size() < 2) return std::nullopt;
  const double center = mean(values);
  const double half = student_t(values.size() - 1, level) * std::sqrt(variance(values) / static_cast<double>(values.size()));
  return Interval{.center = center, .low = center - half, .high = center + half};
}

}  // namespace patrol::score
