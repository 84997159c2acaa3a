#include "slam/consistency/unsupported_path.h"

#include <gtest/gtest.h>

namespace patrol::slam::unsupported_path_test {
namespace {

/// 100 scans, two per second.
const std::vector<Time> kStamps = [] {
  std::vector<Time> stamps;
  for (int k = 0; k < 100; ++k) stamps.push_back(from_seconds(0.5 * k));
  return stamps;
}();

const FaultyOdometry kFault{.fault = OdometryFault::kSlipping, .first_scan = 40, .last_scan = 50, .distance_m = 2.5};

std::size_t num_unsupported(const UnmatchedSegment& segment, const FaultyOdometry& fault = kFault) {
  return find_unsupported_path({segment}, {fault}, kStamps).size();
}

TEST(FindUnsupportedPath, ThreeScansInARowWithinFiveSecondsOfTwoMetersAreAndTwoScansAreNot) {
  EXPECT_EQ(num_unsupported({.first_scan = 44, .num_scans = 3}), 1U);
  EXPECT_EQ(num_unsupported({.first_scan = 44, .num_scans = 2}), 0U);
}

TEST(FindUnsupportedPath, TheLimitOfFiveSecondsHoldsBeforeAndAfterTheFault) {
  EXPECT_EQ(num_unsupported({.first_scan = 60, .num_scans = 3}), 1U);
  EXPECT_EQ(num_unsupported({.first_scan = 61, .num_scans = 3}), 0U);
  EXPECT_EQ(num_unsupported({.first_scan = 28, .num_scans = 3}), 1U);
  EXPECT_EQ(num_unsupported({.first_scan = 27, .num_scans = 3}), 0U);
}

TEST(FindUnsupportedPath, AContradictionOfLessThanTwoMetersLeavesThePathSupported) {
  FaultyOdometry small = kFault;
  small.distance_m = 1.9;
  EXPECT_EQ(num_unsupported({.first_scan = 44, .num_scans = 10}, small), 0U);
}

TEST(FindUnsupportedPath, MostScansAreFirstWithTheLargestContradictionNearby) {
  FaultyOdometry larger = kFault;
  larger.distance_m = 4.0;
  const auto found = find_unsupported_path(
      {{.first_scan = 41, .num_scans = 3}, {.first_scan = 46, .num_scans = 7, .p_map = {1.0, 2.0}}}, {kFault, larger},
      kStamps);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].scans.first_scan, 46U);
  EXPECT_EQ(found[0].scans.p_map, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(found[0].contradiction_m, 4.0);
}

TEST(FindUnsupportedGaps, OfFiveSecondsAndTwoMetersBetweenOdometryAndPathAreAndShorterOrSmallerOnesAreNot) {
  const auto gaps = [](double gap_s, double difference_m) {
    const std::vector<Time> stamps = {from_seconds(0.0), from_seconds(0.5), from_seconds(0.5 + gap_s)};
    const std::vector<Pose2> odometry = {{}, {0.5, 0.0, 0.0}, {0.5 + difference_m, 0.0, 0.0}},
                             path = {{}, {0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}};
    return find_unsupported_gaps(odometry, path, stamps);
  };
  EXPECT_TRUE(gaps(4.9, 3.0).empty());
  EXPECT_TRUE(gaps(6.0, 1.9).empty());
  const auto found = gaps(6.0, 2.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].scans.first_scan, 2U);
  EXPECT_EQ(found[0].scans.num_scans, 0U);
  EXPECT_EQ(found[0].scans.p_map, Eigen::Vector2d(0.5, 0.0));
  EXPECT_NEAR(found[0].contradiction_m, 2.1, 1e-12);
  EXPECT_NEAR(found[0].gap_s, 6.0, 1e-12);
}

}  // namespace
}  // namespace patrol::slam::unsupported_path_test
