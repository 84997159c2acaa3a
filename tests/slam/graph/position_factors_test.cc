#include "slam/graph/position_factors.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::slam::position_factors_test {
namespace {

PositionMeasurement position_at(double time_s) {
  return {.stamp = from_seconds(time_s),
          .p_survey_antenna = {time_s, 0.0},
          .std_m = 0.01,
          .correlation_time_s = 20.0,
          .T_odom_body = {},
          .p_level_antenna = {0.1, 0.0}};
}

// The mean of n positions with the errors of an AR(1) process has 2 tau / dt times the variance of independent ones.
TEST(PositionFactors, CorrelatedPositionsEverySecondWeighAsOneInFortySeconds) {
  PositionFactors factors;
  for (int i = 0; i < 3; ++i) factors.add(i, {}, position_at(i));
  ASSERT_EQ(factors.positions().size(), 3U);
  EXPECT_DOUBLE_EQ(factors.positions()[0].std_m, 0.01);
  EXPECT_DOUBLE_EQ(factors.positions()[1].std_m, 0.01 * std::sqrt(40.0));
  factors.add(3, {}, position_at(102.0));
  EXPECT_DOUBLE_EQ(factors.positions()[3].std_m, 0.01);
}

TEST(PositionFactors, TakesOnePerNodeAndOnePerSecond) {
  PositionFactors factors;
  factors.add(4, {}, position_at(10.0));
  factors.add(4, {}, position_at(12.0));
  factors.add(5, {}, position_at(10.5));
  EXPECT_EQ(factors.positions().size(), 1U);
  factors.add(5, {}, position_at(11.0));
  EXPECT_EQ(factors.positions().size(), 2U);
}

TEST(PositionFactors, TheLeverArmIsReducedToTheNode) {
  PositionFactors factors;
  factors.add(0, {1.0, 2.0, 0.5 * M_PI}, position_at(0.0));
  EXPECT_NEAR(factors.positions()[0].p_node_antenna.x(), 1.0, 1e-12);
  EXPECT_NEAR(factors.positions()[0].p_node_antenna.y(), 2.1, 1e-12);
}

}  // namespace
}  // namespace patrol::slam::position_factors_test
