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

struct Interval {
  double center = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return low <= value && value <= high; }
};

/// Confidence interval of the mean by Student's t, none for fewer than two values.
std::optional<Interval> mean_interval(const std::vector<double>& values, double level = 0.95);

/// Two-sided p-value of Student's t test of a mean of zero. None for fewer than two values; 1 if all values are 0, and
/// 0 if they are all equal otherwise.
std::optional<double> mean_p_value(const std::vector<double>& values);

/// P-values adjusted for their number by Holm's step-down method [Holm79], [p-value]: rejecting those below a level
/// bounds the probability of any false rejection by that level, whatever the dependence between the tests.
std::vector<double> holm_adjusted(const std::vector<double>& p_values);
/// Adjusts p-values in place; none is not counted.
void adjust_by_holm(const std::vector<std::optional<double>*>& p_values);

/// Two-sided exact p-value of the sign test [McNemar47]: probability that of `num_first + num_second` fair coin tosses
/// at least as many fall on one side as on the larger of the two. 1 without any toss.
double sign_test_p_value(int num_first, int num_second);

/// Spearman's rank correlation, -1 ... 1; ties have the mean of their ranks. None when either list is constant or has a
/// NaN.
std::optional<double> rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Probability that a marked value is greater than an unmarked one; ties count half. This is the area under the ROC
/// curve, Mann-Whitney's U / (n m). None unless there are marked and unmarked values, or with a NaN.
std::optional<double> roc_auc(const std::vector<double>& values, const std::vector<bool>& is_marked);

}  // namespace patrol::score
