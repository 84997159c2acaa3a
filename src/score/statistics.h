#pragma once

#include <optional>
#include <vector>

/// Small figures about a list of numbers. An empty list gives 0 throughout: there was nothing to be wrong about.
namespace patrol::score {

double mean(const std::vector<double>& values);
/// Of the sample: n - 1 in the denominator; 0 for fewer than two values.
double variance(const std::vector<double>& values);
double root_mean_square(const std::vector<double>& values);
double maximum(const std::vector<double>& values);

/// The value below which `fraction` of the list lies, linear between neighbours (Hyndman & Fan 1996, type 7).
double percentile(std::vector<double> values, double fraction);

/// Half width of the 95 % confidence interval of the mean, by Student's t; 0 for fewer than two values.
double confidence_95(const std::vector<double>& values);

struct Interval {
  double center = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return low <= value && value <= high; }
};

/// Confidence interval of the mean, by Student's t; none for fewer than two values, which say nothing of their spread.
std::optional<Interval> mean_interval(const std::vector<double>& values, double level = 0.95);

/// Spearman's rank correlation, ties sharing their mean rank, -1 ... 1; none when either list does not vary.
std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Chance that a value of a marked one is greater than a value of an unmarked one, ties counting half (area under the ROC curve,
/// Mann-Whitney U / n m); none without both kinds.
std::optional<double> chance_of_order(const std::vector<double>& values, const std::vector<bool>& is_marked);

}  // namespace patrol::score
