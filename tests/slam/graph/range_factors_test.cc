#include "slam/graph/range_factors.h"

#include <gtest/gtest.h>

namespace patrol::slam::range_factors_test {
namespace {

const UwbAnchor kAnchor{.number = 3, .p_m = {10.0, 0.0, 1.0}};
const UwbAnchor kOther{.number = 4, .p_m = {0.0, 10.0, 1.0}};

/// Without a bias, and with the antenna on the body's axis as high as the anchors: a range is a distance in the plane.
RangeFactors without_bias() {
  return RangeFactors({.range_std_m = 0.15, .common_std_m = 0.0, .calibration = {.distance_m = {}, .bias_m = {}}});
}

RangeMeasurement measurement(const UwbAnchor& anchor, double range_m) {
  return {.anchor = anchor, .range_m = range_m, .T_odom_body = {}, .p_level_antenna = {0.0, 0.0, 1.0}};
}

// The node stands at x = 1, 9 m from the anchor; the robot read 8.7 m when it had come 0.3 m nearer, and 8.6 m when 0.5
// m.
TEST(RangeFactors, RangesBetweenNodesCountAsMeasuredAtTheNode) {
  RangeFactors ranges = without_bias();
  ranges.add(7, {1.0, 0.0, 0.0}, {0.3, 0.0, 0.0}, measurement(kAnchor, 8.7));
  ASSERT_EQ(ranges.ranges().size(), 1U);
  EXPECT_EQ(ranges.ranges()[0].node, 7);
  EXPECT_NEAR(ranges.ranges()[0].range_m, 9.0, 1e-12);
  EXPECT_NEAR(ranges.std_m(ranges.ranges()[0]), 0.15, 1e-12);
  ranges.add(7, {1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, measurement(kAnchor, 8.6));
  ASSERT_EQ(ranges.ranges().size(), 1U);
  EXPECT_NEAR(ranges.ranges()[0].range_m, 0.5 * (9.0 + 9.1), 1e-12);
  EXPECT_NEAR(ranges.std_m(ranges.ranges()[0]), 0.15 / std::sqrt(2.0), 1e-12);
}

TEST(RangeFactors, EveryNodeAndEveryAnchorHasItsOwn) {
  RangeFactors ranges = without_bias();
  for (const int node : {0, 1}) {
    for (const UwbAnchor& anchor : {kAnchor, kOther, kAnchor}) ranges.add(node, {}, {}, measurement(anchor, 10.0));
  }
  ASSERT_EQ(ranges.ranges().size(), 4U);
  const int counts[] = {2, 1, 2, 1};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(ranges.ranges()[i].count, counts[i]) << i;
}

}  // namespace
}  // namespace patrol::slam::range_factors_test
