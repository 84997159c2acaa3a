#include "score/statistics.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace patrol::score::statistics_test {
namespace {

constexpr double kExactTol = 1e-12;

TEST(Statistics, OfOneToFiveAreThreeTwoAndAHalfAndRootEleven) {
  const std::vector<double> values = {5.0, 1.0, 4.0, 2.0, 3.0};
  EXPECT_NEAR(mean(values), 3.0, kExactTol);
  EXPECT_NEAR(variance(values), 2.5, kExactTol);                      // (4 + 1 + 0 + 1 + 4) / 4
  EXPECT_NEAR(root_mean_square(values), std::sqrt(11.0), kExactTol);  // 55 / 5
  EXPECT_NEAR(maximum(values), 5.0, kExactTol);
}

TEST(Statistics, OfNothingAreZero) {
  EXPECT_EQ(mean({}), 0.0);
  EXPECT_EQ(variance({}), 0.0);
  EXPECT_EQ(variance({7.0}), 0.0);
  EXPECT_EQ(root_mean_square({}), 0.0);
  EXPECT_EQ(maximum({}), 0.0);
  EXPECT_EQ(percentile({}, 0.5), 0.0);
  EXPECT_FALSE(mean_interval({7.0}));
}

// Hyndman and Fan's type 7, as R's default.
TEST(Percentile, IsLinearBetweenNeighbours) {
  const std::vector<double> values = {4.0, 1.0, 3.0, 2.0};
  EXPECT_NEAR(percentile(values, 0.25), 1.75, kExactTol);
  EXPECT_NEAR(percentile(values, 0.5), 2.5, kExactTol);
  EXPECT_NEAR(percentile(values, 0.95), 3.85, kExactTol);
  EXPECT_EQ(percentile(values, 0.0), 1.0);
  EXPECT_EQ(percentile(values, 1.0), 4.0);
  EXPECT_EQ(percentile({9.0}, 0.95), 9.0);
}

double half_width(const std::vector<double>& values) {
  const Interval interval = mean_interval(values).value();
  return interval.high - interval.center;
}

/// Half width over the standard error: the quantile of Student's t itself.
double quantile_used(int count) {
  std::vector<double> values(static_cast<std::size_t>(count));
  std::iota(values.begin(), values.end(), 0.0);
  return half_width(values) / std::sqrt(variance(values) / count);
}

TEST(MeanInterval, OfOneToFiveIsOnePointNineSix) {
  EXPECT_NEAR(half_width({1.0, 2.0, 3.0, 4.0, 5.0}), 2.7764 * std::sqrt(2.5 / 5.0), 1e-4);  // 1.9632
}

// Quantiles as tables of the distribution give them.
TEST(MeanInterval, UsesStudentsQuantiles) {
  EXPECT_NEAR(quantile_used(2), 12.7062, 1e-4);
  EXPECT_NEAR(quantile_used(10), 2.2622, 1e-4);
  EXPECT_NEAR(quantile_used(31), 2.0423, 1e-4);
  EXPECT_NEAR(quantile_used(41), 2.0211, 1e-4);
  EXPECT_NEAR(quantile_used(61), 2.0003, 1e-4);
  EXPECT_NEAR(quantile_used(100'001), 1.9600, 1e-4);
}

TEST(MeanInterval, AtNinetyNinePercentIsWiderByTheQuantiles) {
  // t(4) at 95 % is 2.7764, at 99 % 4.6041.
  const std::vector<double> values = {1.0, 2.0, 3.0, 4.0, 5.0};
  const Interval at_95 = mean_interval(values).value(), at_99 = mean_interval(values, 0.99).value();
  EXPECT_DOUBLE_EQ(at_95.center, 3.0);
  EXPECT_NEAR((at_99.high - at_99.center) / (at_95.high - at_95.center), 4.6041 / 2.7764, 1e-4);
  EXPECT_TRUE(at_95.contains(3.5));
  EXPECT_FALSE(at_95.contains(5.5));
}

TEST(MeanInterval, OneValueHasNone) { EXPECT_FALSE(mean_interval({1.0}).has_value()); }

// t = 3 / sqrt(2.5 / 5) = 4.2426 with four degrees of freedom. Closed form: 1 - x (1 + (1 - x^2) / 2), x = t / sqrt(t^2
// + 4).
TEST(MeanPValue, OfOneToFiveIsThatOfTheClosedFormWithFourDegreesOfFreedom) {
  const double t = 3.0 / std::sqrt(0.5), x = t / std::sqrt(t * t + 4.0);
  EXPECT_NEAR(mean_p_value({1.0, 2.0, 3.0, 4.0, 5.0}).value(), 1.0 - x * (1.0 + (1.0 - x * x) / 2.0), 1e-12);
  EXPECT_NEAR(mean_p_value({-1.0, 1.0}).value(), 1.0, kExactTol);
  EXPECT_EQ(mean_p_value({0.0, 0.0}), 1.0);
  EXPECT_EQ(mean_p_value({2.0, 2.0}), 0.0);
  EXPECT_FALSE(mean_p_value({2.0}));
}

TEST(MeanPValue, IsFivePercentWhereTheIntervalEndsAtZero) {
  const std::vector<double> values = {1.0, 2.0, 3.0, 4.0, 5.0};
  std::vector<double> shifted;
  for (const double value : values) shifted.push_back(value - mean_interval(values)->low);
  EXPECT_NEAR(mean_p_value(shifted).value(), 0.05, 1e-9);
}

// By hand: 0.01 * 4, 0.02 * 3, 0.03 * 2 (raised to the one before), 0.04 * 1 (raised).
TEST(HolmAdjusted, StepsDownAndNeverDecreases) {
  const std::vector<double> adjusted = holm_adjusted({0.04, 0.01, 0.03, 0.02});
  EXPECT_NEAR(adjusted[1], 0.04, kExactTol);
  EXPECT_NEAR(adjusted[3], 0.06, kExactTol);
  EXPECT_NEAR(adjusted[2], 0.06, kExactTol);
  EXPECT_NEAR(adjusted[0], 0.06, kExactTol);
  EXPECT_TRUE(holm_adjusted({}).empty());
  EXPECT_EQ(holm_adjusted({0.03}), std::vector<double>{0.03});
  EXPECT_EQ(holm_adjusted({0.7, 0.6}), (std::vector<double>{1.0, 1.0}));
}

// Three of three: 2 / 2^3. Five to one of six: 2 (1 + 6) / 2^6.
TEST(SignTest, IsTheTwoSidedTailOfTheBinomialDistribution) {
  EXPECT_NEAR(sign_test_p_value(3, 0), 0.25, kExactTol);
  EXPECT_NEAR(sign_test_p_value(0, 3), 0.25, kExactTol);
  EXPECT_NEAR(sign_test_p_value(1, 5), 14.0 / 64.0, kExactTol);
  EXPECT_EQ(sign_test_p_value(2, 2), 1.0);
  EXPECT_EQ(sign_test_p_value(0, 0), 1.0);
}

TEST(RankCorrelation, IsOneForAnyGrowingRelationAndMinusOneForAFallingOne) {
  EXPECT_DOUBLE_EQ(*rank_correlation({1, 2, 3, 4}, {1, 8, 27, 64}), 1.0);
  EXPECT_DOUBLE_EQ(*rank_correlation({1, 2, 3, 4}, {9, 5, 2, -7}), -1.0);
  EXPECT_FALSE(rank_correlation({1, 2, 3}, {5, 5, 5}));
}

// Ranks 1, 2.5, 2.5, 4 and 1, 2, 3, 4: 4.5 / sqrt(4.5 * 5).
TEST(RankCorrelation, TiesShareTheirMeanRank) {
  EXPECT_NEAR(*rank_correlation({10, 20, 20, 30}, {1, 2, 3, 4}), 4.5 / std::sqrt(22.5), 1e-12);
}

TEST(ChanceOfOrder, CountsPairsAndTiesHalf) {
  EXPECT_DOUBLE_EQ(*roc_auc({1, 2, 3, 4}, {false, false, true, true}), 1.0);
  EXPECT_DOUBLE_EQ(*roc_auc({1, 3, 2, 4}, {false, false, true, true}), 0.75);
  EXPECT_DOUBLE_EQ(*roc_auc({7, 7}, {false, true}), 0.5);
  EXPECT_FALSE(roc_auc({1, 2}, {true, true}));
}

TEST(RankCorrelation, AndRocAucAreUnknownWithANaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rank_correlation({1, nan, 3}, {1, 2, 3}));
  EXPECT_FALSE(rank_correlation({1, 2, 3}, {nan, nan, nan}));
  EXPECT_FALSE(roc_auc({1, nan, 3}, {false, true, true}));
}

}  // namespace
}  // namespace patrol::score::statistics_test
