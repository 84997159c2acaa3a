#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "plan/navigation/navigator.h"
#include "tests/plan/kinematic_drive.h"
#include "tests/support/pose_near.h"

// The navigator with a robot of 0.7 by 0.36 m that moves sideways with the local planner.
namespace patrol::plan::mecanum_navigation_test {
namespace {

using test::RoomWorld;

RoomWorld make_hall() {
  RoomWorld hall;
  hall.add_box(-6.0, -6.0, 6.0, 6.0);
  return hall;
}

NavigatorSettings make_settings() {
  NavigatorSettings settings;
  settings.kinematics = "omnidirectional";
  settings.footprint_rows = 2;
  settings.goal_approach_distance_m = 0.6;
  settings.local_planner.dwa.max_lateral_speed_mps = 0.25;
  return settings;
}

DriveRecord drive_mecanum(const RoomWorld& hall, const NavigatorSettings& settings, const Pose2& start,
                          const NavigationGoal& goal) {
  Navigator navigator(settings, make_robot(), {});
  navigator.set_map(draw_map(hall, -6.5, -6.5, 6.5, 6.5));
  return drive(navigator, hall, start, goal, 90.0, 0.1);
}

TEST(MecanumNavigation, TwentyGoalsAmongPostsAreReachedTo3CentimetersAnd1DegreeWithoutTouching) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed, "test/hall");
    RoomWorld hall = make_hall();
    const Pose2 start{-4.5, 8.0 * stream.uniform(0) - 4.0, 6.28 * stream.uniform(1)};
    const NavigationGoal goal{.T_map_body = {4.5, 8.0 * stream.uniform(2) - 4.0, 6.28 * stream.uniform(3)},
                              .position_tolerance_m = 0.03,
                              .yaw_tolerance_rad = kDegree};
    for (std::uint64_t post = 0; post < 6; ++post)
      hall.add_post(5.0 * stream.uniform(4, post) - 2.5, 10.0 * stream.uniform(5, post) - 5.0, 0.15);
    const DriveRecord record = drive_mecanum(hall, make_settings(), start, goal);
    EXPECT_EQ(record.end, NavigationStatus::kArrived)
        << "seed " << seed << " at " << record.T_map_body.vector().transpose();
    EXPECT_THAT(record.T_map_body, test::Pose2Near(goal.T_map_body, 0.03, kDegree)) << "seed " << seed;
    EXPECT_GT(record.min_gap_m, 0.0) << "seed " << seed;
    EXPECT_LE(record.max_lateral_speed_mps, 0.25 + 1e-9) << "seed " << seed;
  }
}

// A differential robot would turn by a right angle twice: 3.1 rad.
TEST(MecanumNavigation, AGoalHalfAMeterBesideIsReachedSidewaysWithLessThanAFifthOfARadianOfRotation) {
  const DriveRecord record =
      drive_mecanum(make_hall(), make_settings(), {},
                    {.T_map_body = {0.0, 0.5, 0.0}, .position_tolerance_m = 0.03, .yaw_tolerance_rad = kDegree});
  EXPECT_EQ(record.end, NavigationStatus::kArrived);
  EXPECT_LT(record.turned_rad, 0.2);
  EXPECT_LT(record.way_m, 0.6);
}

}  // namespace
}  // namespace patrol::plan::mecanum_navigation_test
