#include "score/map_error.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::score::map_error_test {
namespace {

constexpr double kFloatTol = 1e-6;

/// Walls round a room: cells of `resolution_m` whose centre lies within half a cell of a rectangle's sides.
OccupancyGrid make_room(double resolution_m, double width_m, double height_m) {
  const double margin_m = 1.0;
  OccupancyGrid map({.resolution_m = resolution_m,
                     .width = static_cast<int>(std::lround((width_m + 2 * margin_m) / resolution_m)),
                     .height = static_cast<int>(std::lround((height_m + 2 * margin_m) / resolution_m)),
                     .origin_m = {-margin_m, -margin_m}},
                    kFree);
  const auto mark = [&](double x, double y) { map.at(map.geometry().cell_at({x, y})) = kOccupied; };
  const double half = resolution_m / 2.0;
  for (double x = half; x < width_m; x += resolution_m) mark(x, half), mark(x, height_m - half);
  for (double y = half; y < height_m; y += resolution_m) mark(half, y), mark(width_m - half, y);
  return map;
}

ReferenceMap all_seeable(const OccupancyGrid& cells) { return {cells, Grid<std::uint8_t>(cells.geometry(), 1)}; }

TEST(MapError, OfThePerfectMapIsNone) {
  const OccupancyGrid room = make_room(0.05, 8.0, 6.0);
  const MapError error = map_error(room, {}, all_seeable(room));
  EXPECT_EQ(error.num_occupied, 2U * 160U + 2U * 120U - 4U);
  EXPECT_NEAR(error.nearest_mean_m, 0.0, kFloatTol);
  EXPECT_NEAR(error.nearest_p95_m, 0.0, kFloatTol);
  EXPECT_EQ(error.coverage, 1.0);
  EXPECT_EQ(error.iou, 1.0);
}

// One wall of 10 m, moved across: every cell is as far away as it was moved.
TEST(MapError, SaysOfEachOccupiedCellHowFarItIs) {
  OccupancyGrid built({.resolution_m = 0.1, .width = 4, .height = 1, .origin_m = {0.0, 0.0}}, kFree), truth = built;
  built.at({0, 0}) = built.at({3, 0}) = kOccupied;
  truth.at({1, 0}) = kOccupied;
  const Grid<float> cells_m = map_error(built, {}, all_seeable(truth)).cells_m;
  EXPECT_NEAR(cells_m.at({0, 0}), 0.1, 1e-6);
  EXPECT_NEAR(cells_m.at({3, 0}), 0.2, 1e-6);
  EXPECT_TRUE(std::isnan(cells_m.at({1, 0})));
}

TEST(MapError, OfAWallMovedFiveCentimetresIsFive) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 200, .height = 40}, kFree);
  for (int col = 0; col < 200; ++col) wall.at({col, 20}) = kOccupied;
  for (const double shift : {0.05, -0.05, 0.15}) {
    const MapError error = map_error(wall, {0.0, shift, 0.0}, all_seeable(wall));
    EXPECT_NEAR(error.nearest_mean_m, std::abs(shift), kFloatTol);
    EXPECT_NEAR(error.nearest_p95_m, std::abs(shift), kFloatTol);
    EXPECT_NEAR(error.nearest_var_m2, 0.0, kFloatTol);
    EXPECT_EQ(error.coverage, std::abs(shift) <= 0.10 ? 1.0 : 0.0);
    EXPECT_EQ(error.iou, 0.0);
  }
}

// A room moved along x: of 596 cells those of the two walls across err by the shift (less the corners), the
// others, moved along themselves, do not, but for the one that sticks out at the end of each.
TEST(MapError, OfARoomMovedFiveCentimetresIsFiveOnTheWallsAcross) {
  const OccupancyGrid room = make_room(0.05, 8.0, 6.0);
  const MapError error = map_error(room, {0.05, 0.0, 0.0}, all_seeable(room));
  EXPECT_NEAR(error.nearest_mean_m, 0.05 * (118 + 120) / 556.0,
              1e-5);  // left: 118 less corners; right: all 120
  EXPECT_NEAR(error.nearest_p95_m, 0.05, kFloatTol);
}

TEST(MapError, TheMapsFrameIsJoinedToTheWorldFirst) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 100, .height = 100, .origin_m = {-2.5, -2.5}}, kFree);
  OccupancyGrid turned = wall;
  for (int i = 0; i < 100; ++i) wall.at({i, 60}) = kOccupied, turned.at({60, i}) = kOccupied;
  // A quarter turn takes the wall along y, right of the origin, to one along x above it.
  EXPECT_NEAR(map_error(turned, {0.0, 0.0, M_PI / 2.0}, all_seeable(wall)).nearest_mean_m, 0.0, 1e-5);
}

// The floor that map_error.h states: the reference's surface cells begin at the surface (half a cell behind
// it on average), the built map's cells hold the surface anywhere: r/4 + q^2 / (4 r) on average.
TEST(MapError, OfAPerfectMapOfLargerCellsIsOnePointSixCentimetres) {
  constexpr double r = 0.05, q = 0.025;
  OccupancyGrid reference({.resolution_m = q, .width = 80, .height = 80}, kFree);
  for (int col = 0; col < 80; ++col) reference.at({col, 40}) = kOccupied;
  const double surface_m = 40 * q;
  constexpr int kPlaces = 100;
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {  // the built map's grid lies anywhere against the wall
    const double origin_y = 0.5 + r * (i + 0.5) / kPlaces;
    OccupancyGrid built({.resolution_m = r, .width = 20, .height = 20, .origin_m = {0.5 + q / 2.0, origin_y}}, kFree);
    const int row = built.geometry().cell_at({0.6, surface_m}).row;
    for (int col = 0; col < 20; ++col) built.at({col, row}) = kOccupied;
    sum += map_error(built, {}, all_seeable(reference)).nearest_mean_m / kPlaces;
  }
  EXPECT_NEAR(sum, r / 4.0 + q * q / (4.0 * r), 1e-4);
}

TEST(MapError, HalfAWallIsHalfTheCoverageButNoLessPrecise) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 200, .height = 10}, kFree), half = wall;
  for (int col = 0; col < 200; ++col) wall.at({col, 5}) = kOccupied;
  for (int col = 0; col < 100; ++col) half.at({col, 5}) = kOccupied;
  const MapError error = map_error(half, {}, all_seeable(wall));
  EXPECT_NEAR(error.nearest_mean_m, 0.0, kFloatTol);
  EXPECT_NEAR(error.coverage, 0.51, kFloatTol) << "the half and the two cells within 10 cm of it";
  EXPECT_NEAR(error.iou, 0.5, kFloatTol);
}

TEST(MapError, WhatLiesOutsideTheBuiltMapIsMissed) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 200, .height = 10}, kFree),
      part({.resolution_m = 0.05, .width = 50, .height = 10}, kFree);
  for (int col = 0; col < 200; ++col) wall.at({col, 5}) = kOccupied;
  for (int col = 0; col < 50; ++col) part.at({col, 5}) = kOccupied;
  EXPECT_NEAR(map_error(part, {}, all_seeable(wall)).iou, 0.25, kFloatTol);
}

TEST(MapError, WhatCouldNotBeSeenIsNotMissed) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 200, .height = 10}, kFree), half = wall;
  for (int col = 0; col < 200; ++col) wall.at({col, 5}) = kOccupied;
  for (int col = 0; col < 100; ++col) half.at({col, 5}) = kOccupied;
  ReferenceMap reference = all_seeable(wall);
  for (int row = 0; row < 10; ++row) {
    for (int col = 100; col < 200; ++col) reference.is_observable.at({col, row}) = 0;
  }
  const MapError error = map_error(half, {}, reference);
  EXPECT_EQ(error.coverage, 1.0);
  EXPECT_EQ(error.iou, 1.0);
}

TEST(MapError, AGhostTwoMetresOffRaisesTheMeanByItsShare) {
  OccupancyGrid wall({.resolution_m = 0.05, .width = 99, .height = 100}, kFree);
  for (int col = 0; col < 99; ++col) wall.at({col, 5}) = kOccupied;
  OccupancyGrid ghost = wall;
  ghost.at({50, 45}) = kOccupied;
  EXPECT_NEAR(map_error(ghost, {}, all_seeable(wall)).nearest_mean_m, 2.0 / 100.0, kFloatTol);
}

TEST(MapError, WithoutOccupiedCellsIsRefused) {
  const OccupancyGrid room = make_room(0.05, 2.0, 2.0);
  const OccupancyGrid empty({.resolution_m = 0.05, .width = 10, .height = 10}, kFree);
  EXPECT_THROW(map_error(empty, {}, all_seeable(room)), InputError);
  EXPECT_THROW(map_error(room, {}, all_seeable(empty)), InputError);
  EXPECT_THROW(map_error(room, {}, {room, Grid<std::uint8_t>(room.geometry(), 0)}), InputError)
      << "nothing was seeable";
}

}  // namespace
}  // namespace patrol::score::map_error_test
