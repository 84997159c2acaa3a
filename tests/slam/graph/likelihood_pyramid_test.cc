#include "slam/graph/likelihood_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
    const int level = static_cast<int>(6.0 * u[2]), col = static_cast<int>(500.0 * u[0]) - 50,
              row = static_cast<int>(400.0 * u[1]) - 50, side = 1 << level;
    const int at_shift =
        pyramid.value(0, col + static_cast<int>(side * shift[0]), row + static_cast<int>(side * shift[1]));
    ASSERT_GE(pyramid.value(level, col, row), at_shift) << "level " << level << ", cell " << col << ", " << row;
  }
}

// The offset from the center, -2.5 cm, rounds to a float beyond the edge: the surface is in the pyramid's cell before
// the tile.
TEST(LikelihoodPyramid, HoldsHitsOnTheLowEdgesOfTiles) {
  GridMap at_left(0.05, 4000.0), at_bottom(0.05, 4000.0);
  at_left.add_hit({-1.6, 0.02});
  at_bottom.add_hit({0.02, -1.6});
  const LikelihoodPyramid left(at_left, 0.1, 7), bottom(at_bottom, 0.1, 7);
  for (int along = -40; along < 40; ++along) {
    for (int across = -40; across < 40; ++across) {
      const int steps_across = std::abs(across + 17), steps_along = std::abs(along);
      const bool is_near = steps_across <= 2 && steps_along <= 2;
      const int squared_distance = steps_across * steps_across + steps_along * steps_along;
      const int expected = is_near ? static_cast<int>(std::lround(100.0 * std::exp(-0.5 * squared_distance))) : 0;
      ASSERT_EQ(left.value(0, across, along), expected) << "left, " << across << ", " << along;
      ASSERT_EQ(bottom.value(0, along, across), expected) << "bottom, " << along << ", " << across;
    }
  }
}

// The cells of the pyramid need not be a multiple of the map's.
TEST(LikelihoodPyramid, ContainsHitsOnAllTileEdgesAtEveryResolution) {
  for (const double resolution_m : {0.03, 0.05, 0.07, 0.1, 0.13}) {
    for (int edge = -64; edge <= 64; edge += 32) {
      GridMap map(0.05, 4000.0);
      map.add_hit({0.05 * edge - 1e-9, 0.05 * edge});
      map.add_hit({0.05 * edge, 0.05 * edge - 1e-9});
      const LikelihoodPyramid pyramid(map, resolution_m, 3);
      int highest = 0;
      const int center = static_cast<int>(std::floor(0.05 * edge / resolution_m));
      for (int col = center - 1; col <= center + 1; ++col) {
        for (int row = center - 1; row <= center + 1; ++row) highest = std::max(highest, pyramid.value(0, col, row));
      }
      EXPECT_EQ(highest, LikelihoodPyramid::kOnSurface) << resolution_m << " m, edge " << edge;
    }
  }
}

TEST(LikelihoodPyramid, OfAnEmptyMapIsZeroEverywhere) {
  const LikelihoodPyramid pyramid(GridMap(0.05, 100.0), 0.1, 4);
  for (int level = 0; level < 4; ++level) EXPECT_EQ(pyramid.value(level, 3, -7), 0) << level;
}

}  // namespace
}  // namespace patrol::slam::likelihood_pyramid_test
