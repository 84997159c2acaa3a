#include "slam/consistency/frozen_scans.h"

#include <limits>

#include <gtest/gtest.h>

namespace patrol::slam::frozen_scans_test {
namespace {

/// Scans 0.1 m apart by odometry; from `first` on, `num_repeats` of them repeat scan first - 1.
std::vector<UnmatchedSegment> frozen_of(std::size_t first, std::size_t num_repeats, double step_m = 0.1,
                                        std::size_t num_returns = 10) {
  constexpr std::size_t kScans = 30, kBeams = 12;
  FrozenScans frozen;
  std::vector<Pose2> T_map_body;
  RecordedScan recorded;
  for (std::size_t k = 0; k < kScans; ++k) {
    T_map_body.push_back({static_cast<double>(k), 0.0, 0.0});
    recorded.T_odom_body = {step_m * static_cast<double>(k), 0.0, 0.0};
    if (k < first || k >= first + num_repeats) {
      recorded.scan.ranges_m.assign(kBeams, std::numeric_limits<float>::quiet_NaN());
      for (std::size_t beam = 0; beam < num_returns; ++beam)
        recorded.scan.ranges_m[beam] = 2.0F + 0.001F * static_cast<float>(k);
    }
    frozen.add(recorded);
  }
  return frozen.find(T_map_body);
}

TEST(FrozenScans, FourRepetitionsInMotionAreFrozenWithTheirPlaceAndThreeAreNot) {
  const std::vector<UnmatchedSegment> frozen = frozen_of(10, 4);
  ASSERT_EQ(frozen.size(), 1U);
  EXPECT_EQ(frozen[0].first_scan, 10U);
  EXPECT_EQ(frozen[0].num_scans, 4U);
  EXPECT_EQ(frozen[0].p_map.x(), 10.0);
  EXPECT_EQ(num_scans_of(frozen), 4U);
  EXPECT_TRUE(frozen_of(10, 3).empty());
}

TEST(FrozenScans, ThatLastUntilTheEndOfTheLogAreFound) {
  const std::vector<UnmatchedSegment> frozen = frozen_of(20, 10);
  ASSERT_EQ(frozen.size(), 1U);
  EXPECT_EQ(frozen[0].num_scans, 10U);
}

TEST(FrozenScans, RepetitionsAtRestAndScansWithoutReturnsAreNotFrozen) {
  EXPECT_TRUE(frozen_of(10, 10, 0.01).empty());
  EXPECT_TRUE(frozen_of(10, 10, 0.1, 2).empty());
}

}  // namespace
}  // namespace patrol::slam::frozen_scans_test
