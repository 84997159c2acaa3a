#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "plan/navigation/navigator.h"
#include "tests/plan/kinematic_drive.h"
#include "tests/plan/tracked_settings.h"
#include "tests/support/pose_near.h"

// The navigator with a robot of 1.0 by 0.7 m that cannot step sideways.
namespace patrol::plan::tracked_navigation_test {
namespace {

using test::RoomWorld;

/// 16 m by 16 m about the origin.
RoomWorld make_hall() {
  RoomWorld hall;
  hall.add_box(-8.0, -8.0, 8.0, 8.0);
  return hall;
}

Navigator make_navigator(const RoomWorld& known, const NavigatorSettings& settings = make_tracked_settings()) {
  Navigator navigator(settings, make_tracked_robot(), {});
  navigator.set_map(draw_map(known, -8.5, -8.5, 8.5, 8.5));
  return navigator;
}

DriveRecord drive_tracked(Navigator& navigator, const RoomWorld& world, const Pose2& start, const NavigationGoal& goal,
                          double turn_slip = 0.25, double time_limit_s = 120.0) {
  return drive(navigator, world, start, goal, time_limit_s, 0.1, make_tracked_robot(), turn_slip);
}

TEST(TrackedNavigation, TwentyGoalsAmongPostsAreReachedToThreeCentimetresAndOneDegreeWithoutTouching) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed, "test/hall");
    RoomWorld hall = make_hall();
    const Pose2 start{-6.0, 10.0 * stream.uniform(0) - 5.0, 6.28 * stream.uniform(1)};
    const NavigationGoal goal{.T_map_body = {6.0, 10.0 * stream.uniform(2) - 5.0, 6.28 * stream.uniform(3)},
                              .position_tolerance_m = 0.03,
                              .yaw_tolerance_rad = kDegree};
    for (std::uint64_t post = 0; post < 6; ++post) {
      hall.add_post(7.0 * stream.uniform(4, post) - 3.5, 14.0 * stream.uniform(5, post) - 7.0, 0.2);
    }
    Navigator navigator = make_navigator(hall);
    const DriveRecord record = drive_tracked(navigator, hall, start, goal, 0.1 + 0.3 * stream.uniform(6));
    EXPECT_EQ(record.end, NavigationStatus::kArrived)
        << "seed " << seed << " at " << record.T_map_body.vector().transpose();
    EXPECT_THAT(record.T_map_body, test::Pose2Near(goal.T_map_body, 0.03, kDegree)) << "seed " << seed;
    EXPECT_GT(record.min_gap_m, 0.0) << "seed " << seed;
    EXPECT_EQ(record.max_lateral_speed_mps, 0.0) << "seed " << seed;
    EXPECT_TRUE(record.recoveries.empty()) << "seed " << seed;
  }
}

// A wall 0.9 m behind the robot's middle, 0.4 m behind its tail, and a goal 5 cm to the left: it shuffles ahead.
TEST(TrackedNavigation, ShufflesAheadWhereThereIsNoRoomBehind) {
  RoomWorld hall = make_hall();
  hall.add_box(-3.0, -2.0, -0.9, 2.0);
  Navigator navigator = make_navigator(hall);
  const NavigationGoal goal{.T_map_body = {0.0, 0.05, 0.0}, .position_tolerance_m = 0.02, .yaw_tolerance_rad = kDegree};
  const DriveRecord record = drive_tracked(navigator, hall, {}, goal);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
}

// Nose to a wall 0.75 m ahead, the goal behind: no room for an arc, but for a turn in place.
TEST(TrackedNavigation, TurnsInPlaceToLeaveADeadEnd) {
  RoomWorld hall = make_hall();
  hall.add_box(0.75, -2.0, 2.0, 2.0);
  Navigator navigator = make_navigator(hall);
  const NavigationGoal goal{.T_map_body = {-5.0, 0.0, 0.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const DriveRecord record = drive_tracked(navigator, hall, {}, goal);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
  EXPECT_LT(record.way_m, 7.0);
}

/// A wall across the hall with a gap about y = 0.
RoomWorld make_gap(double width_m) {
  RoomWorld hall = make_hall();
  hall.add_box(-0.2, width_m / 2.0, 0.2, 8.0).add_box(-0.2, -8.0, 0.2, -width_m / 2.0);
  return hall;
}

// What A* plans through, the dynamic window passes: of every width of gap the robot either passes it without touching
// and without a recovery, or there is no route: 0.7 m wide, margins of 5 and 8 cm on each side, and cells of 10 cm.
TEST(TrackedNavigation, PassesEveryGapThatItPlansThrough) {
  const NavigationGoal goal{.T_map_body = {4.0, 0.3, 0.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  for (double width_m = 0.70; width_m < 1.31; width_m += 0.05) {
    const RoomWorld hall = make_gap(width_m);
    Navigator navigator = make_navigator(hall);
    const DriveRecord record = drive_tracked(navigator, hall, {-4.0, 0.5, 0.0}, goal, 0.25, 80.0);
    EXPECT_GT(record.min_gap_m, 0.0) << width_m;
    if (record.num_plans == 0) {
      EXPECT_EQ(record.end, NavigationStatus::kFailed) << width_m;
      EXPECT_EQ(record.failure, NavigationFailure::kNoRoute) << width_m;
      EXPECT_LT(width_m, 1.16);
    } else {
      EXPECT_EQ(record.end, NavigationStatus::kArrived) << width_m;
      EXPECT_TRUE(record.recoveries.empty()) << width_m;
      EXPECT_GT(width_m, 0.86);
    }
  }
}

// Somebody walks across 3 m before the robot at 1 m/s: no new path for that.
TEST(TrackedNavigation, LetsAPersonWalkByWithoutANewPath) {
  const RoomWorld hall = make_hall();
  Navigator navigator = make_navigator(hall);
  const NavigationGoal goal{.T_map_body = {6.0, 0.0, 0.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const auto world_at = [&](double time_s) {
    RoomWorld world = hall;
    return world.add_post(1.0, -5.0 + time_s, 0.25);
  };
  const DriveRecord record = drive(navigator, world_at, {-5.0, 0.0, 0.0}, goal, 80.0, 0.1, make_tracked_robot(), 0.25);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_EQ(record.num_detours, 0);
  EXPECT_GT(record.min_gap_m, 0.2);
  EXPECT_LT(record.way_m, 12.0);
}

TEST(TrackedNavigation, GoesRoundWhatStays) {
  RoomWorld hall = make_hall();
  Navigator navigator = make_navigator(hall);
  hall.add_post(1.0, 0.1, 0.3);
  const NavigationGoal goal{.T_map_body = {6.0, 0.0, 0.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const DriveRecord record = drive_tracked(navigator, hall, {-5.0, 0.0, 0.0}, goal);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
  EXPECT_THAT(record.recoveries, ::testing::IsEmpty());
}

TEST(TrackedNavigation, PapersDwaDrivesItAcrossTheHallToo) {
  RoomWorld hall = make_hall();
  hall.add_post(0.0, 0.2, 0.3);
  NavigatorSettings settings = make_tracked_settings();
  settings.local_planner.method = "dwa_liu21";
  Navigator navigator = make_navigator(hall, settings);
  const NavigationGoal goal{.T_map_body = {5.0, 1.0, 0.5}, .position_tolerance_m = 0.05, .yaw_tolerance_rad = 0.05};
  const DriveRecord record = drive_tracked(navigator, hall, {-5.0, 0.0, 0.0}, goal);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
}

}  // namespace
}  // namespace patrol::plan::tracked_navigation_test
