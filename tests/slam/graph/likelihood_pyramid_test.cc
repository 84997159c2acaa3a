#include "slam/graph/likelihood_pyramid.h"

#include <gtest/gtest.h>

#include "slam/scan_integration.h"
#include "tests/slam/graph/office_world.h"

namespace patrol::slam::likelihood_pyramid_test {
namespace {

GridMap look_once(const Pose2& T_map_body) {
  GridMap map(0.05, 200.0);
  integrate_scan(test::make_office().scan(T_map_body, test::kOldLidar), T_map_body, {}, map);
  return map;
}

TEST(LikelihoodPyramid, IsHundredOnAWallNegativeInFrontAndZeroBehind) {
  GridMap map(0.05, 100.0);
  test::RoomWorld wall;
  wall.add_wall(3.05, -5.0, 3.05, 5.0);
  for (int i = 0; i < 3; ++i) integrate_scan(wall.scan({}, {.beams = 1600, .range_max_m = 10.0}), {}, {}, map);
  const LikelihoodPyramid pyramid(map, 0.1, 3);
  EXPECT_EQ(pyramid.value(0, 30, 0), LikelihoodPyramid::kOnSurface);
  EXPECT_EQ(pyramid.value(0, 29, 0), 61);  // 100 exp(-1/2)
  EXPECT_EQ(pyramid.value(0, 28, 0), 14);  // 100 exp(-2)
  EXPECT_EQ(pyramid.value(0, 20, 0), LikelihoodPyramid::kInFreeSpace);
  EXPECT_EQ(pyramid.value(0, 40, 0), 0);
  EXPECT_EQ(pyramid.value(0, 4000, -4000), 0);
}

// What branch and bound rests on: at every level, for every place and every shift by less than a cell.
TEST(LikelihoodPyramid, EveryLevelBoundsAllShiftsWithinItsCell) {
  const LikelihoodPyramid pyramid(look_once({8.0, 4.2, 0.3}), 0.1, 6);
  const RandomStream draws(1, "test/pyramid");
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const auto u = draws.uniforms(i, 0), shift = draws.uniforms(i, 1);
    const int level = static_cast<int>(6.0 * u[2]), col = static_cast<int>(500.0 * u[0]) - 50, row = static_cast<int>(400.0 * u[1]) - 50, side = 1 << level;
    const int at_shift = pyramid.value(0, col + static_cast<int>(side * shift[0]), row + static_cast<int>(side * shift[1]));
    ASSERT_GE(pyramid.value(level, col, row), at_shift) << "level " << level << ", cell " << col << ", " << row;
  }
}

TEST(LikelihoodPyramid, OfAnEmptyMapIsZeroEverywhere) {
  const LikelihoodPyramid pyramid(GridMap(0.05, 100.0), 0.1, 4);
  for (int level = 0; level < 4; ++level) EXPECT_EQ(pyramid.value(level, 3, -7), 0) << level;
}

}  // namespace
}  // namespace patrol::slam::likelihood_pyramid_test
