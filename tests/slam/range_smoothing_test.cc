#include "slam/range_smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"

namespace patrol::slam::range_smoothing_test {
namespace {

constexpr double kStep_rad = to_rad(1.0);

/// Scan of 121 beams over 120 degrees; `range_m` of the angle.
template <typename Range>
LaserScan scan_of(Range&& range_m, double std_m, std::uint64_t seed) {
  const RandomStream noise(seed, "test/range_smoothing");
  LaserScan scan;
  scan.angle_min_rad = -60.0 * kStep_rad;
  scan.angle_increment_rad = kStep_rad;
  for (int beam = 0; beam <= 120; ++beam) {
    const double range = range_m(scan.angle_min_rad + beam * kStep_rad);
    scan.ranges_m.push_back(static_cast<float>(range + std_m * noise.normal(static_cast<std::uint64_t>(beam))));
  }
  return scan;
}

/// Wall at a distance of 2 m ahead, seen at up to 60 degrees.
double wall_m(double angle_rad) { return 2.0 / std::cos(angle_rad); }

double rms_error_m(const std::vector<float>& ranges_m, const std::vector<float>& true_m, std::size_t first,
                   std::size_t last) {
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) sum += std::pow(static_cast<double>(ranges_m[i] - true_m[i]), 2);
  return std::sqrt(sum / static_cast<double>(last - first + 1));
}

TEST(SmoothedRanges, AStraightWallWithoutNoiseStaysToATenthOfAMillimeter) {
  const LaserScan scan = scan_of(wall_m, 0.0, 1);
  const std::vector<float> smoothed = smoothed_ranges(scan, 0.1);
  ASSERT_EQ(smoothed.size(), scan.ranges_m.size());
  for (std::size_t i = 0; i < smoothed.size(); ++i) EXPECT_NEAR(smoothed[i], scan.ranges_m[i], 1e-4) << i;
}

// At 2 m there are seven neighbors on each side. A line through n ranges has a standard deviation of 1 / sqrt(n) of
// theirs in its middle; the biweight uses fourteen fifteenths of the information.
TEST(SmoothedRanges, TheNoiseOfAStraightWallIsThatOfALineThroughTheNeighbors) {
  const std::vector<float> wall = scan_of(wall_m, 0.0, 1).ranges_m;
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    sum += rms_error_m(smoothed_ranges(scan_of(wall_m, 0.1, seed), 0.1), wall, 45, 75);
  EXPECT_NEAR(sum / 20.0, 0.1 / std::sqrt(14.0), 0.004);
}

TEST(SmoothedRanges, SurfacesBesideAnEdgeDoNotMix) {
  const auto edge_m = [](double angle_rad) { return angle_rad < 0.0 ? 2.0 : 4.0; };
  const std::vector<float> truth = scan_of(edge_m, 0.0, 1).ranges_m;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::vector<float> smoothed = smoothed_ranges(scan_of(edge_m, 0.1, seed), 0.1);
    for (std::size_t i = 55; i <= 65; ++i) EXPECT_NEAR(smoothed[i], truth[i], 0.4) << seed << ' ' << i;
    EXPECT_LT(rms_error_m(smoothed, truth, 55, 65), 0.1) << seed;
  }
}

TEST(SmoothedRanges, APostOfOneBeamKeepsItsRange) {
  LaserScan scan = scan_of(wall_m, 0.0, 1);
  scan.ranges_m[60] = 1.2F;
  const std::vector<float> smoothed = smoothed_ranges(scan, 0.1);
  EXPECT_EQ(smoothed[60], 1.2F);
  EXPECT_NEAR(smoothed[59], wall_m(-kStep_rad), 1e-3);
  EXPECT_NEAR(smoothed[61], wall_m(kStep_rad), 1e-3);
}

TEST(SmoothedRanges, DistantBeamsStay) {
  const LaserScan scan = scan_of([](double) { return 8.0; }, 0.1, 1);  // 0.14 m apart
  EXPECT_EQ(smoothed_ranges(scan, 0.1), scan.ranges_m);
}

TEST(SmoothedRanges, BeamsWithoutReturnStayAndDoNotCount) {
  LaserScan scan = scan_of(wall_m, 0.0, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  scan.ranges_m[40] = nan, scan.ranges_m[50] = infinity, scan.ranges_m[60] = 0.0F, scan.ranges_m[70] = -1.0F;
  const std::vector<float> smoothed = smoothed_ranges(scan, 0.1);
  EXPECT_TRUE(std::isnan(smoothed[40]));
  EXPECT_EQ(smoothed[50], infinity);
  EXPECT_EQ(smoothed[60], 0.0F);
  EXPECT_EQ(smoothed[70], -1.0F);
  EXPECT_NEAR(smoothed[51], scan.ranges_m[51], 1e-4);
  EXPECT_TRUE(smoothed_ranges(LaserScan{}, 0.1).empty());
}

TEST(SmoothedRanges, TheDirectionOfTheBeamsDoesNotMatter) {
  const LaserScan scan = scan_of(wall_m, 0.1, 5);
  LaserScan reversed = scan;
  std::reverse(reversed.ranges_m.begin(), reversed.ranges_m.end());
  reversed.angle_min_rad = -scan.angle_min_rad;
  reversed.angle_increment_rad = -scan.angle_increment_rad;
  std::vector<float> smoothed = smoothed_ranges(reversed, 0.1);
  std::reverse(smoothed.begin(), smoothed.end());
  EXPECT_THAT(smoothed, testing::Pointwise(testing::FloatNear(1e-5F), smoothed_ranges(scan, 0.1)));
}

}  // namespace
}  // namespace patrol::slam::range_smoothing_test
