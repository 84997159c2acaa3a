#include "slam/match_points.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::slam::match_points_test {
namespace {

using test::VectorNear;

LevelScan scan_of(const std::vector<Eigen::Vector2f>& ends, bool are_hits = true) {
  LevelScan scan;
  for (const Eigen::Vector2f& end : ends) scan.beams.push_back({end, are_hits});
  return scan;
}

TEST(DownsampleScan, NeighborsWithinTheSpacingBecomeTheirMean) {
  const auto points = downsample_scan(scan_of({{1.0F, 0.0F}, {1.0F, 0.04F}, {1.0F, 0.08F}, {1.0F, 0.2F}}), 0.1, 100);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_THAT(points[0].p_body, VectorNear(Eigen::Vector2d(1.0, 0.04), 1e-6));
  EXPECT_THAT(points[1].p_body, VectorNear(Eigen::Vector2d(1.0, 0.2), 1e-6));
}

TEST(DownsampleScan, RangesCountFromTheLidar) {
  LevelScan scan = scan_of({{3.0F, 4.0F}});
  scan.origin_m = {3.0, 1.0};
  EXPECT_NEAR(downsample_scan(scan, 0.1, 100)[0].range_m, 3.0, 1e-6);
}

TEST(DownsampleScan, TakeNoBeamsWithoutEchoAndNoInvalidOnes) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(downsample_scan(scan_of({{1.0F, 0.0F}, {2.0F, 0.0F}}, false), 0.1, 100).empty());
  EXPECT_EQ(downsample_scan(scan_of({{nan, 0.0F}, {1.0F, infinity}, {2.0F, 0.0F}}), 0.1, 100).size(), 1U);
  EXPECT_TRUE(downsample_scan({}, 0.1, 100).empty());
}

TEST(DownsampleScan, KeepEveryTenthOfAThousandWhenAHundredAreAllowed) {
  std::vector<Eigen::Vector2f> ends;
  for (int i = 0; i < 1000; ++i) ends.emplace_back(static_cast<float>(i), 0.0F);
  const auto points = downsample_scan(scan_of(ends), 0.1, 100);
  ASSERT_EQ(points.size(), 100U);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_DOUBLE_EQ(points[i].p_body.x(), 10.0 * static_cast<double>(i));
}

}  // namespace
}  // namespace patrol::slam::match_points_test
