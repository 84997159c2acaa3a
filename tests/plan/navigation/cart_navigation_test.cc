#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "core/wheel_kinematics.h"
#include "plan/navigation/navigator.h"
#include "tests/plan/kinematic_drive.h"
#include "tests/support/pose_near.h"

// The navigator with a cart that cannot turn in place.
namespace patrol::plan::cart_navigation_test {
namespace {

using test::RoomWorld;

NavigatorSettings cart_settings() {
  NavigatorSettings settings;
  settings.kinematics = "ackermann";
  settings.footprint_rows = 2;
  settings.no_progress_timeout_s = 40.0;
  settings.recovery.behaviors = {"wait", "back_up"};
  settings.local_planner.dwa.max_reverse_mps = 0.5;
  return settings;
}

RoomWorld make_hall() {
  RoomWorld hall;
  hall.add_box(-10.0, -10.0, 10.0, 10.0);
  return hall;
}

Navigator make_navigator(const RoomWorld& known) {
  Navigator navigator(cart_settings(), make_cart(), {});
  navigator.set_map(draw_map(known, -10.5, -10.5, 10.5, 10.5));
  return navigator;
}

TEST(CartNavigation, TwentyGoalsAmongPostsAreReachedTo8CentimetersAnd3DegreesWithoutATouchOrATighterTurn) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed, "test/cart");
    RoomWorld hall = make_hall();
    const Pose2 start{-7.0, 10.0 * stream.uniform(0) - 5.0, 6.28 * stream.uniform(1)};
    const NavigationGoal goal{.T_map_body = {7.0, 10.0 * stream.uniform(2) - 5.0, 6.28 * stream.uniform(3)},
                              .position_tolerance_m = 0.08,
                              .yaw_tolerance_rad = 3.0 * kDegree};
    for (std::uint64_t post = 0; post < 5; ++post)
      hall.add_post(8.0 * stream.uniform(4, post) - 4.0, 16.0 * stream.uniform(5, post) - 8.0, 0.2);
    Navigator navigator = make_navigator(hall);
    const DriveRecord record = drive(navigator, hall, start, goal, 180.0, 0.1, make_cart());
    EXPECT_EQ(record.end, NavigationStatus::kArrived) << seed << " at " << record.T_map_body.vector().transpose();
    EXPECT_THAT(record.T_map_body, test::Pose2Near(goal.T_map_body, 0.08, 3.0 * kDegree)) << seed;
    EXPECT_GT(record.min_gap_m, 0.0) << seed;
    EXPECT_LE(record.max_curvature_per_m, 1.0 / 1.3 + 1e-6) << seed;
    EXPECT_EQ(record.max_lateral_speed_mps, 0.0) << seed;
  }
}

// A goal 3 m to the left with the same heading takes a maneuver forward and backward, or a loop.
TEST(CartNavigation, ReachesAPlaceBesideItself) {
  const RoomWorld hall = make_hall();
  Navigator navigator = make_navigator(hall);
  const NavigationGoal goal{.T_map_body = {0.0, 3.0, 0.0}, .position_tolerance_m = 0.08, .yaw_tolerance_rad = 0.06};
  const DriveRecord record = drive(navigator, hall, {}, goal, 120.0, 0.1, make_cart());
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.way_m, 3.0);
  EXPECT_LT(record.way_m, 25.0);
}

// 3.8 m between the walls: it can neither drive a circle nor turn in place.
TEST(CartNavigation, TurnsAroundInADeadEndByDrivingBackAndForth) {
  RoomWorld world;
  world.add_box(-8.0, -1.9, 8.0, 1.9);
  Navigator navigator(cart_settings(), make_cart(), {});
  navigator.set_map(draw_map(world, -8.5, -2.5, 8.5, 2.5));
  const NavigationGoal goal{.T_map_body = {-4.0, 0.0, M_PI}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const DriveRecord record = drive(navigator, world, {4.0, 0.0, 0.0}, goal, 180.0, 0.1, make_cart());
  EXPECT_EQ(record.end, NavigationStatus::kArrived) << record.T_map_body.vector().transpose();
  EXPECT_GT(record.min_gap_m, 0.0);
}

TEST(CartNavigation, ADirectionlessGoalIsPassedWithoutATurnAtItsEnd) {
  const RoomWorld hall = make_hall();
  for (const double tolerance_rad : {3.0, M_PI}) {
    Navigator navigator = make_navigator(hall);
    const NavigationGoal goal{
        .T_map_body = {6.0, 0.0, 2.0}, .position_tolerance_m = 0.3, .yaw_tolerance_rad = tolerance_rad};
    const DriveRecord record = drive(navigator, hall, {-6.0, 0.0, 0.0}, goal, 60.0, 0.1, make_cart());
    EXPECT_EQ(record.end, NavigationStatus::kArrived) << tolerance_rad;
    EXPECT_LT(record.way_m, 12.5) << tolerance_rad;
  }
}

TEST(CartNavigation, AGoalWithoutRoomForTheCartIsReported) {
  RoomWorld hall = make_hall();
  hall.add_box(4.0, -0.6, 5.2, 0.6);
  Navigator navigator = make_navigator(hall);
  const NavigationGoal goal{.T_map_body = {4.4, 0.0, 0.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const DriveRecord record = drive(navigator, hall, {-6.0, 0.0, 0.0}, goal, 20.0, 0.1, make_cart());
  EXPECT_EQ(record.failure, NavigationFailure::kGoalBlocked);
}

// Toward a keep-out line, and beside it, where the front of the cart swings out as it straightens.
TEST(CartNavigation, GoalsWithinTheRouteMarginAreReached) {
  const RoomWorld hall = make_hall();
  NavigatorSettings settings = cart_settings();
  settings.costmap.route_margin_m = 0.08;
  for (const auto& [yaw, clearance_m] : {std::pair{0.0, 0.005}, {0.0, 0.03}, {0.0, 0.06}, {0.5 * M_PI, 0.06}}) {
    Navigator navigator(settings, make_cart(), {{{4.0, -9.0}, {4.0, 9.0}}});
    navigator.set_map(draw_map(hall, -10.5, -10.5, 10.5, 10.5));
    Pose2 T_map_goal{2.0, 0.0, yaw};
    for (int i = 0; i < 3; ++i) T_map_goal.x += navigator.costmap().clearance_m(T_map_goal) - clearance_m;
    ASSERT_NEAR(navigator.costmap().clearance_m(T_map_goal), clearance_m, 1e-3);
    const NavigationGoal goal{
        .T_map_body = T_map_goal, .position_tolerance_m = 0.08, .yaw_tolerance_rad = 3.0 * kDegree};
    const DriveRecord record = drive(navigator, hall, {-6.0, -3.0, 0.0}, goal, 60.0, 0.1, make_cart());
    EXPECT_EQ(record.end, NavigationStatus::kArrived) << yaw << ", " << clearance_m;
    EXPECT_TRUE(record.recoveries.empty()) << yaw << ", " << clearance_m;
  }
}

// 1.6 m between the walls: the cart fits across, but it has no room to turn. Each search takes more than half a second
// on the robot's computer, so that one is running most of the time.
TEST(CartNavigation, AGoalThatEverySearchMissesIsAbortedAfterTheRecoveries) {
  RoomWorld world;
  world.add_box(-8.0, -0.8, 8.0, 0.8);
  NavigatorSettings settings = cart_settings();
  settings.planner_cells_per_s = 1e6;
  settings.recovery.max_attempts = 3;
  Navigator navigator(settings, make_cart(), {});
  navigator.set_map(draw_map(world, -8.5, -1.5, 8.5, 1.5));
  const NavigationGoal goal{
      .T_map_body = {-4.0, -0.3, M_PI / 2.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  const DriveRecord record = drive(navigator, world, {4.0, 0.0, 0.0}, goal, 120.0, 0.1, make_cart());
  EXPECT_EQ(record.end, NavigationStatus::kFailed);
  EXPECT_EQ(record.failure, NavigationFailure::kNoRoute);
  EXPECT_GE(record.recoveries.size(), 3U);
  EXPECT_LT(record.time_s, 90.0);
}

TEST(CartNavigation, ARobotWithoutSteeredWheelsIsRefused) {
  EXPECT_THROW(Navigator(cart_settings(), make_tracked_robot(), {}), InputError);
}

}  // namespace
}  // namespace patrol::plan::cart_navigation_test
