#include "slam/map_rendering.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::map_rendering_test {
namespace {

using test::VectorNear;

int count_of(const OccupancyGrid& grid, std::int8_t value) {
  return static_cast<int>(std::count(grid.values().begin(), grid.values().end(), value));
}

TEST(RenderMap, IsCroppedToTheObservedCellsAndKeepsTheFrame) {
  GridMap map(0.5, 100.0);
  for (int i = 0; i < 2; ++i) map.add_hit({-2.2, 1.3}), map.add_hit({3.1, 4.9});
  const OccupancyGrid grid = render_map(map, 2);
  EXPECT_DOUBLE_EQ(grid.geometry().resolution_m, 0.5);
  EXPECT_THAT(grid.geometry().origin_m, VectorNear(Eigen::Vector2d(-2.5, 1.0), 1e-12));
  EXPECT_EQ(grid.geometry().width, 12);  // -2.5 ... 3.5
  EXPECT_EQ(grid.geometry().height, 8);  // 1 ... 5
  EXPECT_EQ(grid.at({0, 0}), kOccupied);
  EXPECT_EQ(grid.at({11, 7}), kOccupied);
  EXPECT_EQ(count_of(grid, kOccupied), 2);
  EXPECT_EQ(count_of(grid, kUnknown), 94);
}

TEST(RenderMap, IsFreeWhereBeamsPassedAndUnknownElsewhere) {
  GridMap map(0.5, 100.0);
  map.add_free_ray({0.25, 0.25}, {2.25, 0.25}, 1, false);
  map.add_free_ray({0.25, 0.25}, {0.25, 1.25}, 1, false);
  const OccupancyGrid grid = render_map(map, 1);
  EXPECT_EQ(count_of(grid, kFree), 5 + 2);
  EXPECT_EQ(grid.at({1, 1}), kUnknown);
  EXPECT_EQ(grid.at({4, 0}), kFree);
}

TEST(RenderMap, ACellWithFewerHitsThanTheMinimumIsAnOutlier) {
  GridMap map(0.5, 100.0);
  map.add_hit({0.25, 0.25});
  EXPECT_EQ(count_of(render_map(map, 2), kOccupied), 0);
  map.add_hit({0.25, 0.25});
  EXPECT_EQ(count_of(render_map(map, 2), kOccupied), 1);
}

// Two hits against six passes: still a surface to match with, but less than half of the beams ended there.
TEST(RenderMap, ACellThatMoreBeamsPassedThanHitHasMovedOn) {
  GridMap map(0.5, 100.0);
  for (int i = 0; i < 2; ++i) map.add_hit({2.25, 0.25});
  map.add_free_ray({0.25, 0.25}, {4.25, 0.25}, 6, false);
  ASSERT_TRUE(map.is_surface({4, 0}));
  EXPECT_EQ(render_map(map, 2).at({4, 0}), kOccupied);
  EXPECT_EQ(render_map(map, 2, 0.25).at({4, 0}), kOccupied);
  EXPECT_EQ(render_map(map, 2, 0.26).at({4, 0}), kFree);
}

// Two centimeters of noise strew the hits of a wall at y = 0.48 over three rows of 5 cm; one row is drawn.
TEST(RenderMap, ANoisyWallIsOneCellThickInItsCell) {
  GridMap map(0.05, 100.0);
  const RandomStream noise(1, "test/wall");
  for (std::uint64_t i = 0; i < 40'000; ++i) map.add_hit({10.0 * noise.uniform(i, 1), 0.48 + 0.02 * noise.normal(i)});
  const OccupancyGrid grid = render_map(map, 2);
  const Cell wall = grid.geometry().cell_at({0.025, 0.48});
  int in_row = 0;
  for (int col = 0; col < grid.geometry().width; ++col) in_row += grid.at({col, wall.row}) == kOccupied ? 1 : 0;
  EXPECT_GE(in_row, 195);  // of 200
  EXPECT_LE(count_of(grid, kOccupied) - in_row, 5);
}

TEST(RenderMap, OfNothingIsEmpty) { EXPECT_EQ(render_map(GridMap(0.05, 100.0), 2).values().size(), 0U); }

}  // namespace
}  // namespace patrol::slam::map_rendering_test
