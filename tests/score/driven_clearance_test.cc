#include "score/driven_clearance.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::score::driven_clearance_test {
namespace {

constexpr double kExactTol = 1e-9;

/// 0.6 m long, 0.4 m wide.
const std::vector<Eigen::Vector2d> kOutline = {{0.3, 0.2}, {-0.3, 0.2}, {-0.3, -0.2}, {0.3, -0.2}};

/// 10 m x 10 m of 0.1 m, its lower-left corner at the origin, free but for these cells.
OccupancyGrid map_with(const std::vector<Cell>& occupied) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 100, .height = 100, .origin_m = {0.0, 0.0}}, kFree);
  for (const Cell cell : occupied) map.at(cell) = kOccupied;
  return map;
}

Trajectory drive_along_x(double y_m, double yaw, double from_m, double to_m) {
  Trajectory way;
  for (int i = 0; i <= 100; ++i)
    way.push_back({from_seconds(0.1 * i), to_pose3(Pose2{from_m + (to_m - from_m) * i / 100.0, y_m, yaw})});
  return way;
}

// The cell's centre lies at (5.05, 6.05): at the nearest place it is 1.05 m aside of the body's centre.
TEST(DrivenClearance, IsFromTheOutlinesSideToACellsCentre) {
  const DrivenClearance along = driven_clearance(drive_along_x(5.0, 0.0, 1.0, 9.0), kOutline, map_with({{50, 60}}));
  EXPECT_NEAR(along.min_m, 1.05 - 0.2, kExactTol);
  EXPECT_GT(along.mean_m, along.p05_m);
  EXPECT_GE(along.p05_m, along.min_m);
  const DrivenClearance across =
      driven_clearance(drive_along_x(5.0, std::numbers::pi / 2.0, 1.0, 9.0), kOutline, map_with({{50, 60}}));
  EXPECT_NEAR(across.min_m, 1.05 - 0.3, kExactTol);
}

TEST(DrivenClearance, IsNoughtWhereItTouchesAndThreeMetresWhereNothingIsNear) {
  EXPECT_EQ(driven_clearance(drive_along_x(5.0, 0.0, 1.0, 9.0), kOutline, map_with({{50, 50}})).min_m, 0.0);
  const DrivenClearance alone = driven_clearance(drive_along_x(5.0, 0.0, 1.0, 9.0), kOutline, map_with({}));
  EXPECT_EQ(alone.min_m, kMaxClearance_m);
  EXPECT_EQ(alone.mean_m, kMaxClearance_m);
}

TEST(DrivenClearance, CountsPlacesATenthOfAMetreApart) {
  EXPECT_NEAR(
      static_cast<double>(driven_clearance(drive_along_x(5.0, 0.0, 1.0, 9.0), kOutline, map_with({})).num_positions),
      8.0 / 0.16 + 1.0, 1.0);  // steps of 0.08 m: every other
  EXPECT_EQ(driven_clearance(drive_along_x(5.0, 0.0, 1.0, 1.0), kOutline, map_with({})).num_positions,
            1u);  // standing still
}

TEST(DrivenClearance, FromAKeepOutLineIsThatOfTheOutlinesSideAndNoughtWhereItCrossesTheLine) {
  const std::vector<std::vector<Eigen::Vector2d>> beside = {{{0.0, 6.0}, {10.0, 6.0}}},
                                                  across = {{{5.0, 4.0}, {5.0, 6.0}}};
  const Trajectory way = drive_along_x(5.0, 0.0, 1.0, 9.0);
  EXPECT_NEAR(driven_clearance(way, kOutline, map_with({}), beside).keep_out_min_m.value(), 1.0 - 0.2, kExactTol);
  EXPECT_EQ(driven_clearance(way, kOutline, map_with({}), across).keep_out_min_m, 0.0);
  EXPECT_FALSE(driven_clearance(way, kOutline, map_with({})).keep_out_min_m);
}

TEST(DrivenClearance, OfNoWayOrNoOutlineIsNothing) {
  EXPECT_EQ(driven_clearance({}, kOutline, map_with({})).num_positions, 0u);
  EXPECT_EQ(driven_clearance(drive_along_x(5.0, 0.0, 1.0, 9.0), {}, map_with({})).num_positions, 0u);
}

}  // namespace
}  // namespace patrol::score::driven_clearance_test
