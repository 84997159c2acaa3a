#pragma once

#include <optional>
#include <vector>

/// Basic statistics of a list of numbers. Functions that return a number give 0 for an empty list.
namespace patrol::score {

double mean(const std::vector<double>& values);
/// Sample variance: n - 1 in the denominator. 0 for fewer than two values.
double variance(const std::vector<double>& values);
double root_mean_square(const std::vector<double>& values);
double maximum(const std::vector<double>& values);

/// Percentile with linear interpolation [Hyndman96, type 7]; `fraction` in 0 ... 1.
double percentile(std::vector<double> values, double fraction);

/// Half width of the 95 % confidence interval of the mean by Student's t, 0 for fewer than two values.
double confidence_95(const std::vector<double>& values);

struct Interval {
  double center = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return low <= value && value <= high; }
};

/// Confidence interval of the mean by Student's t, none for fewer than two values.
std::optional<Interval> mean_interval(const std::vector<double>& values, double level = 0.95);

/// Spearman's rank correlation, -1 ... 1; ties have the mean of their ranks. None when either list is constant.
std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Probability that a marked value is greater than an unmarked one; ties count half. This is the area under the ROC
/// curve, Mann-Whitney's U / (n m). None unless there are marked and unmarked values.
std::optional<double> roc_auc(const std::vector<double>& values, const std::vector<bool>& is_marked);

}  // namespace patrol::score
