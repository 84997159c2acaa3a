#include "plan/navigation/navigator.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/plan/kinematic_drive.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::navigator_test {
namespace {

using std::numbers::pi;
using test::RoomWorld;

constexpr double kRoom_m = 6.0;  ///< half the room's side

RoomWorld make_room() {
  RoomWorld room;
  room.add_box(-kRoom_m, -kRoom_m, kRoom_m, kRoom_m);
  return room;
}

/// A corridor 2 m wide, 16 m long, along x.
RoomWorld make_corridor() {
  RoomWorld corridor;
  corridor.add_box(-2.0, -1.0, 14.0, 1.0);
  return corridor;
}

OccupancyGrid map_of_room(const RoomWorld& room) {
  return draw_map(room, -kRoom_m - 0.5, -kRoom_m - 0.5, kRoom_m + 0.5, kRoom_m + 0.5);
}
OccupancyGrid map_of_corridor(const RoomWorld& corridor) { return draw_map(corridor, -2.5, -1.5, 14.5, 1.5); }

NavigatorSettings with_patience(double blocked_timeout_s, double back_up_s, int max_recoveries) {
  NavigatorSettings settings;
  settings.blocked_timeout_s = blocked_timeout_s;
  settings.recovery.back_up_duration_s = back_up_s;
  settings.recovery.max_attempts = max_recoveries;
  return settings;
}

Navigator make_navigator(const OccupancyGrid& map, const NavigatorSettings& settings = {},
                         const std::vector<Polyline>& keep_out_lines = {}) {
  Navigator navigator(settings, make_robot(), keep_out_lines);
  navigator.set_map(map);
  return navigator;
}

NavigationGoal make_goal(const Pose2& T_map_body) {
  return {.T_map_body = T_map_body, .position_tolerance_m = 0.05, .yaw_tolerance_rad = 0.05};
}

// 8 m at up to 0.8 m/s: 10 s, and a few to turn, to slow down and to aim.
TEST(Navigator, ArrivesAcrossAnEmptyRoomWithinItsTolerances) {
  const RoomWorld room = make_room();
  Navigator navigator = make_navigator(map_of_room(room));
  const DriveRecord record = drive(navigator, room, {-4.0, 0.0, 0.0}, make_goal({4.0, 0.0, pi / 2.0}), 60.0);
  ASSERT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_THAT(record.T_map_body, test::Pose2Near(Pose2{4.0, 0.0, pi / 2.0}, 0.05, 0.05));
  EXPECT_LT(record.time_s, 25.0);
  EXPECT_LT(record.way_m, 8.0 * 1.05);
  EXPECT_THAT(record.recoveries, ::testing::IsEmpty());
}

TEST(Navigator, DrivesToTwentyRandomGoalsAmongPostsAndNeverTouches) {
  int num_arrived = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed, "test/room");
    RoomWorld room = make_room();
    const Pose2 start{-4.5, 8.0 * stream.uniform(0) - 4.0, 6.28 * stream.uniform(1)};
    const Pose2 goal{4.5, 8.0 * stream.uniform(2) - 4.0, 6.28 * stream.uniform(3)};
    for (std::uint64_t post = 0; post < 6; ++post) {
      room.add_post(5.0 * stream.uniform(4, post) - 2.5, 10.0 * stream.uniform(5, post) - 5.0, 0.15);
    }
    Navigator navigator = make_navigator(map_of_room(room));
    const DriveRecord record = drive(navigator, room, start, make_goal(goal), 90.0);
    EXPECT_EQ(record.end, NavigationStatus::kArrived)
        << "seed " << seed << " at " << record.T_map_body.vector().transpose();
    EXPECT_GT(record.min_gap_m, 0.0) << "seed " << seed;
    num_arrived += record.end == NavigationStatus::kArrived;
  }
  EXPECT_EQ(num_arrived, 20);
}

// Twelve rooms of which the map knows the outer walls only, with seven boxes that the lidar finds on the way.
TEST(Navigator, DrivesAmongBoxesThatTheMapDoesNotKnow) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const RandomStream stream(seed, "test/boxes");
    RoomWorld room = make_room();
    const OccupancyGrid map = map_of_room(room);
    for (std::uint64_t box = 0; box < 7; ++box) {
      const Eigen::Vector2d center(7.0 * stream.uniform(0, box) - 3.5, 10.0 * stream.uniform(1, box) - 5.0);
      const Eigen::Vector2d half(0.15 + 0.4 * stream.uniform(2, box), 0.15 + 0.4 * stream.uniform(3, box));
      room.add_box(center.x() - half.x(), center.y() - half.y(), center.x() + half.x(), center.y() + half.y());
    }
    const Pose2 start{-5.0, 8.0 * stream.uniform(4) - 4.0, 6.28 * stream.uniform(5)};
    const Pose2 goal{5.0, 8.0 * stream.uniform(6) - 4.0, 6.28 * stream.uniform(7)};
    Navigator navigator = make_navigator(map);
    const DriveRecord record = drive(navigator, room, start, make_goal(goal), 120.0, 0.2);
    EXPECT_EQ(record.end, NavigationStatus::kArrived) << "seed " << seed;
    EXPECT_GT(record.min_gap_m, 0.0) << "seed " << seed;
  }
}

// A legged robot takes about a fifth of a second to do what it is told.
TEST(Navigator, ALagOfAFifthOfASecondDoesNotMakeItTouch) {
  RoomWorld room = make_room();
  room.add_box(-0.5, -1.0, 0.5, 5.9).add_box(2.0, -5.9, 2.5, 0.5);
  Navigator navigator = make_navigator(map_of_room(room));
  const DriveRecord record = drive(navigator, room, {-4.0, 1.0, 0.0}, make_goal({4.5, 0.0, pi}), 90.0, 0.2);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.05);
  EXPECT_THAT(record.recoveries, ::testing::IsEmpty());
}

TEST(Navigator, WithoutAMapFindsItsWayByWhatItSees) {
  RoomWorld room = make_room();
  room.add_box(-0.5, -2.0, 0.5, 2.0);  // in the straight way
  Navigator navigator({}, make_robot(), {});
  const DriveRecord record = drive(navigator, room, {-3.0, 0.0, 0.0}, make_goal({3.0, 0.0, 0.0}), 90.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
}

// The map knows an empty corridor; a box stands in its right half. Left are 1.1 m for a robot 0.36 m wide.
TEST(Navigator, PassesABoxInACorridorThatTheMapDoesNotKnow) {
  RoomWorld corridor = make_corridor();
  const OccupancyGrid map = map_of_corridor(corridor);
  corridor.add_box(5.0, -0.9, 5.6, -0.1);
  Navigator navigator = make_navigator(map);
  const DriveRecord record = drive(navigator, corridor, {0.0, 0.0, 0.0}, make_goal({12.0, 0.0, 0.0}), 90.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
  EXPECT_THAT(record.recoveries, ::testing::IsEmpty());
}

// A box in the corridor's right half that the map does not know: 0.8 m/s while it is 5 m away, 0.4 m/s at 2.5 m.
TEST(Navigator, SlowsDownNearWhatTheMapDoesNotKnow) {
  const auto speed_with_box_at = [](double x_m) {
    RoomWorld corridor = make_corridor();
    NavigatorSettings settings;
    settings.unmapped_obstacle_slowdown_distance_m = 3.0;
    settings.unmapped_obstacle_max_speed_mps = 0.4;
    Navigator navigator = make_navigator(map_of_corridor(corridor), settings);
    navigator.set_goal(make_goal({12.0, 0.0, 0.0}));
    corridor.add_box(x_m, -0.9, x_m + 0.4, -0.5);
    double speed_mps = 0.0;
    for (Time now{}; now < from_seconds(3.0); now += from_seconds(0.05)) {
      LevelScan scan = corridor.scan({}, {.beams = 720});
      scan.stamp = now;
      navigator.add_scan(scan, {});
      speed_mps = navigator.step(now, {}).command.vx_mps;
    }
    return speed_mps;
  };
  EXPECT_NEAR(speed_with_box_at(5.0), DwaSettings{}.max_speed_mps, 0.05);
  EXPECT_NEAR(speed_with_box_at(2.5), 0.4, 0.05);
}

// A box appears 3 m before the robot when it is already on its way, and leaves a gap of 0.9 m.
TEST(Navigator, PlansANewPathWhenSomethingIsPutInItsWay) {
  RoomWorld empty = make_corridor(), blocked = make_corridor();
  blocked.add_box(6.0, -0.6, 6.5, 0.1);
  NavigatorSettings settings;
  settings.replan_period_s = 600.0;  // so that nothing but the obstacle asks for a new path
  Navigator navigator = make_navigator(map_of_corridor(empty), settings);
  const DriveRecord record = drive(
      navigator, [&](double time_s) { return time_s < 4.0 ? empty : blocked; }, {0.0, 0.0, 0.0},
      make_goal({12.0, 0.0, 0.0}), 90.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.min_gap_m, 0.0);
  EXPECT_GE(record.num_detours, 1);
  EXPECT_THAT(record.recoveries, ::testing::IsEmpty());
}

// Somebody stands across the whole corridor for 20 s and goes away.
TEST(Navigator, WaitsForABlockedCorridorToClear) {
  RoomWorld empty = make_corridor(), blocked = make_corridor();
  blocked.add_box(6.0, -0.99, 6.3, 0.99);
  Navigator navigator = make_navigator(map_of_corridor(empty));
  const DriveRecord record = drive(
      navigator, [&](double time_s) { return time_s < 20.0 ? blocked : empty; }, {0.0, 0.0, 0.0},
      make_goal({12.0, 0.0, 0.0}), 90.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GT(record.time_s, 20.0);
  EXPECT_GT(record.min_gap_m, 0.0);
}

// A wall across the room: four times 1 s of patience and 0.5 s of backing up, the fourth being one too many.
TEST(Navigator, WalledInSaysThatItFailed) {
  RoomWorld room = make_room();
  room.add_box(-0.1, -kRoom_m, 0.1, kRoom_m);
  Navigator navigator = make_navigator(map_of_room(room), with_patience(1.0, 0.5, 3));
  const DriveRecord record = drive(navigator, room, {-3.0, 0.0, 0.0}, make_goal({3.0, 0.0, 0.0}), 60.0);
  EXPECT_EQ(record.end, NavigationStatus::kFailed);
  EXPECT_LT(record.time_s, 20.0);
  EXPECT_GT(record.min_gap_m, 0.0);
}

TEST(Navigator, TellsAGoalInAWallFromOneWithoutARoute) {
  NavigatorSettings settings;
  settings.no_path_timeout_s = 5.0;
  RoomWorld room = make_room();
  room.add_box(-0.1, -kRoom_m, 0.1, kRoom_m).add_box(-5.0, -1.0, -3.0, 1.0);
  Navigator navigator = make_navigator(map_of_room(room), settings);
  const DriveRecord in_wall = drive(navigator, room, {-2.0, 0.0, 0.0}, make_goal({0.0, 2.0, 0.0}), 30.0);
  EXPECT_EQ(in_wall.end, NavigationStatus::kFailed);
  EXPECT_EQ(in_wall.failure, NavigationFailure::kGoalBlocked);
  EXPECT_THAT(
      in_wall.texts,
      ::testing::ElementsAre("Goal pose is blocked: obstacle, keep-out line or unknown space.",
                             "Navigation aborted: Goal pose is blocked: obstacle, keep-out line or unknown space."));
  EXPECT_NEAR(in_wall.time_s, 5.0, 1.0);
  const DriveRecord behind = drive(navigator, room, {-2.0, 0.0, 0.0}, make_goal({3.0, 0.0, 0.0}), 30.0);
  EXPECT_EQ(behind.end, NavigationStatus::kFailed);
  EXPECT_EQ(behind.failure, NavigationFailure::kNoRoute);
  EXPECT_EQ(behind.texts.back(), "Navigation aborted: No path to the goal exists.");
  const DriveRecord walled_in = drive(navigator, room, {-4.0, 0.0, 0.0}, make_goal({-1.0, 3.0, 0.0}), 30.0);
  EXPECT_EQ(walled_in.failure, NavigationFailure::kNoRoute);
  const DriveRecord free = drive(navigator, room, {-2.0, 0.0, 0.0}, make_goal({-1.0, 2.9, 0.0}), 30.0);
  EXPECT_EQ(free.end, NavigationStatus::kArrived);
  EXPECT_EQ(free.failure, NavigationFailure::kNone);
}

// The corridor is blocked for 12 s. Six seconds of patience, then it turns round once, then it is free.
TEST(Navigator, LooksAroundAsARecovery) {
  RoomWorld empty = make_corridor(), blocked = make_corridor();
  blocked.add_box(3.0, -0.99, 3.3, 0.99);
  NavigatorSettings settings;
  settings.recovery.behaviors = {"spin"};
  Navigator navigator = make_navigator(map_of_corridor(empty), settings);
  const DriveRecord record = drive(
      navigator, [&](double time_s) { return time_s < 16.0 ? blocked : empty; }, {0.0, 0.0, 0.0},
      make_goal({12.0, 0.0, 0.0}), 90.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_GE(record.recoveries.size(), 1u);
  EXPECT_THAT(record.recoveries, ::testing::Each("Recovery: spinning in place."));
  EXPECT_GT(record.turned_rad, 2.0 * pi);
}

TEST(Navigator, RefusesAnEmptyListOfRecoveries) {
  NavigatorSettings settings;
  settings.recovery.behaviors = {};
  EXPECT_THAT([&] { Navigator(settings, make_robot(), {}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("navigation.recovery.behaviors")));
}

// Nose on, 25 cm from the wall and less: nearer than discs and margins allow. It may not circle before such a
// place for ever.
TEST(Navigator, AGoalThatItsOutlineDoesNotFitFailsInsteadOfCircling) {
  const RoomWorld room = make_room();
  for (const double x : {5.4, 5.5, 5.6, 6.5}) {
    NavigatorSettings settings = with_patience(1.0, 0.5, 2);
    settings.no_progress_timeout_s = 10.0;
    Navigator navigator = make_navigator(map_of_room(room), settings);
    const DriveRecord record = drive(navigator, room, {3.0, 0.0, 0.0}, make_goal({x, 0.0, 0.0}), 120.0);
    EXPECT_EQ(record.end, NavigationStatus::kFailed) << x;
    EXPECT_LT(record.time_s, 60.0) << x;
    EXPECT_GT(record.min_gap_m, 0.0) << x;
  }
}

// The lidar does not see the line; it leaves a way round its northern end.
TEST(Navigator, KeepsToItsSideOfAKeepOutLine) {
  const RoomWorld room = make_room();
  const Polyline line{{0.0, -kRoom_m}, {0.0, 3.0}};
  RoomWorld kerb;
  kerb.add_polyline(line);
  Navigator navigator = make_navigator(map_of_room(room), {}, {line});
  const DriveRecord record = drive(navigator, room, {-3.0, 0.0, 0.0}, make_goal({3.0, 0.0, 0.0}), 60.0);
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  for (const Eigen::Vector2d& p : record.way)
    ASSERT_GT(kerb.distance_m(p), 0.15) << p.transpose();  // keep_out_margin_m is 0.2
}

TEST(Navigator, WithoutAGoalStandsIdle) {
  Navigator navigator({}, make_robot(), {});
  const NavigationStep step = navigator.step(Time{}, {});
  EXPECT_EQ(step.status, NavigationStatus::kIdle);
  EXPECT_EQ(step.command.vx_mps, 0.0);
  EXPECT_EQ(step.command.yaw_rate_radps, 0.0);
}

TEST(Navigator, AtItsGoalHasArrivedAtOnceAndStands) {
  Navigator navigator({}, make_robot(), {});
  navigator.set_goal(make_goal({1.0, 1.0, 1.0}));
  const NavigationStep step = navigator.step(Time{}, {1.01, 1.0, 1.0});
  EXPECT_EQ(step.status, NavigationStatus::kArrived);
  EXPECT_EQ(step.command.vx_mps, 0.0);
}

TEST(Navigator, HavingArrivedItDoesNotChaseItsOwnDrift) {
  Navigator navigator({}, make_robot(), {});
  navigator.set_goal(make_goal({0.0, 0.0, 0.0}));
  navigator.step(Time{}, {});
  EXPECT_EQ(navigator.step(from_seconds(0.1), {0.2, 0.0, 0.0}).status, NavigationStatus::kArrived);
  navigator.set_goal(make_goal({2.0, 0.0, 0.0}));  // another goal: off again
  EXPECT_EQ(navigator.step(from_seconds(0.2), {0.2, 0.0, 0.0}).status, NavigationStatus::kDriving);
}

TEST(Navigator, PublishesThePathItPlans) {
  const RoomWorld room = make_room();
  Navigator navigator = make_navigator(map_of_room(room));
  navigator.set_goal(make_goal({3.0, 2.0, 0.0}));
  const NavigationStep first = navigator.step(Time{}, {-3.0, -2.0, 0.0});
  ASSERT_TRUE(first.replanned);
  EXPECT_FALSE(first.is_detour);
  EXPECT_NEAR(first.path.front().x, -3.0, 1e-9);
  EXPECT_NEAR(first.path.back().x, 3.0, 1e-9);
  EXPECT_NEAR(first.path.back().y, 2.0, 1e-9);
  const NavigationStep second = navigator.step(from_seconds(0.05), {-3.0, -2.0, 0.0});
  EXPECT_FALSE(second.replanned);
  EXPECT_TRUE(second.path.empty());
}

// Some tens of cells at a thousand a second: the robot stands for that long, then has its path.
TEST(Navigator, HasARouteOnlyWhenItsComputerWouldHaveFoundIt) {
  const RoomWorld room = make_room();
  NavigatorSettings settings;
  settings.planner_cells_per_s = 1000.0;
  Navigator navigator = make_navigator(map_of_room(room), settings);
  navigator.set_goal(make_goal({4.0, 0.0, 0.0}));
  const Pose2 start{-4.0, 0.0, 0.0};
  const std::int64_t num_expanded = GlobalPlanner(settings.global_planner, 0)
                                        .plan(navigator.costmap().cost(), start.position(), {4.0, 0.0})
                                        .num_expanded;
  const double expected_s = static_cast<double>(num_expanded) / 1000.0;
  ASSERT_GT(expected_s, 0.05);
  double found_s = 0.0;
  for (NavigationStep step = navigator.step(Time{}, start); !step.replanned;
       step = navigator.step(from_seconds(found_s), start)) {
    EXPECT_EQ(step.status, NavigationStatus::kDriving);
    EXPECT_EQ(step.command.vx_mps, 0.0);
    found_s += 0.01;
    ASSERT_LT(found_s, 10.0);
  }
  EXPECT_NEAR(found_s, expected_s, 0.011);
}

TEST(Navigator, SaysThatItsPlannerFoundNothingWhereThatProvesNothing) {
  const RoomWorld room = make_room();
  NavigatorSettings settings;
  settings.global_planner.method = "q_learning";
  settings.global_planner.family.q_learning.episodes = 1;
  settings.global_planner.family.q_learning.max_steps_per_cell = 0.1;
  Navigator navigator = make_navigator(map_of_room(room), settings);
  navigator.set_goal(make_goal({4.0, 0.0, 0.0}));
  const NavigationStep step = navigator.step(Time{}, {-4.0, 0.0, 0.0});
  EXPECT_EQ(step.failure, NavigationFailure::kNotFound);
  EXPECT_EQ(step.text, "Planner failed to find a path (planner is not complete).");
}

TEST(Navigator, GivesTheSameCommandsAgain) {
  RoomWorld room = make_room();
  room.add_post(0.3, 0.2, 0.4);
  const auto run = [&] {
    Navigator navigator = make_navigator(map_of_room(room));
    return drive(navigator, room, {-4.0, 0.0, 1.0}, make_goal({4.0, 1.0, 0.0}), 60.0);
  };
  const DriveRecord a = run(), b = run();
  EXPECT_EQ(a.T_map_body.vector(), b.T_map_body.vector());
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.way_m, b.way_m);
}

TEST(Navigator, RefusesARobotWithoutAnOutlineAndSettingsThatBreakTheirRule) {
  EXPECT_THROW(Navigator({}, RobotDescription{}, {}), InputError);
  NavigatorSettings settings;
  settings.goal_approach_distance_m = -1.0;
  EXPECT_THAT([&] { Navigator(settings, make_robot(), {}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("navigation.goal_approach_distance_m = -1")));
}

}  // namespace
}  // namespace patrol::plan::navigator_test
