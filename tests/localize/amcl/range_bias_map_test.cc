#include "localize/amcl/range_bias_map.h"

#include <gtest/gtest.h>

namespace patrol::localize::range_bias_map_test {
namespace {

const UwbAnchor kAnchor{.number = 1, .p_m = {0.0, 4.0, 2.0}};

/// Mean of `count` ranges that are `error_m` too long, at a position on the x axis.
slam::MappedRange mapped(double x_m, double error_m, int count, int anchor = 1) {
  const Pose2 T_map_body{x_m, 0.0, 0.3};
  const Eigen::Vector3d antenna(0.1, 0.0, 0.5);
  return {.anchor = anchor,
          .T_map_body = T_map_body,
          .p_level_antenna = antenna,
          .range_m = predict_uwb_range(kAnchor, T_map_body, antenna, {}).range_m + error_m,
          .count = count};
}

TEST(RangeBiasMap, TheMeanErrorOfAnAnchorIsWeightedByTheNumberOfRanges) {
  const RangeBiasMap map({mapped(0.0, 0.3, 10), mapped(50.0, 0.1, 30)}, {kAnchor});
  EXPECT_NEAR(map.bias_m(1), 0.15, 1e-12);
}

TEST(RangeBiasMap, WhereManyRangesAreMeasuredTheirErrorIsReturnedAndTheMeanFarAway) {
  const RangeBiasMap map({mapped(0.0, 0.3, 2000), mapped(50.0, 0.1, 2000)}, {kAnchor});
  EXPECT_NEAR(map.bias_m(1, {0.0, 0.0}), 0.3, 1e-3);
  EXPECT_NEAR(map.bias_m(1, {50.0, 1.0}), 0.1, 1e-3);
  EXPECT_NEAR(map.bias_m(1, {25.0, 0.0}), 0.2, 1e-3);
}

// Ten ranges weigh as much as the mean of all positions.
TEST(RangeBiasMap, TenRangesAtAPositionGiveHalfWayBetweenTheirErrorAndTheMean) {
  const RangeBiasMap map({mapped(0.0, 0.3, 10), mapped(100.0, 0.0, 990)}, {kAnchor});
  EXPECT_NEAR(map.bias_m(1), 0.003, 1e-12);
  EXPECT_NEAR(map.bias_m(1, {0.0, 0.0}), 0.1515, 1e-9);
}

TEST(RangeBiasMap, AnAnchorWithoutRangesAndRangesOfAnUnknownAnchorGiveZero) {
  const RangeBiasMap map({mapped(0.0, 0.3, 10, 7)}, {kAnchor});
  EXPECT_EQ(map.bias_m(1), 0.0);
  EXPECT_EQ(map.bias_m(7, {0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace patrol::localize::range_bias_map_test
