#include "plan/control/dwa_liu21.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::plan::paper_dwa_test {
namespace {

using std::numbers::pi;

constexpr double kExactTol = 1e-12;

TEST(DwaLiu21, Equation2IsTheRectangleOfTheRobotsLimits) {
  const VelocityWindow window = speed_window({.min_speed_mps = -0.1, .max_speed_mps = 0.9, .max_yaw_rate_radps = 0.7});
  EXPECT_EQ(window.min_speed_mps, -0.1);
  EXPECT_EQ(window.max_speed_mps, 0.9);
  EXPECT_EQ(window.min_yaw_rate_radps, -0.7);
  EXPECT_EQ(window.max_yaw_rate_radps, 0.7);
}

// From 0.4 m/s and 0.1 rad/s within 0.5 s: braking at 0.6, driving off at 0.2 m/s^2; 1 and 2 rad/s^2. The paper prints
// a minus in the upper bounds too, which would end the window below where it begins.
TEST(DwaLiu21, Equation3ReachesFromBrakingToDrivingOff) {
  const DwaLiu21Settings settings{.max_deceleration_mps2 = 0.6,
                                  .max_acceleration_mps2 = 0.2,
                                  .max_yaw_deceleration_radps2 = 1.0,
                                  .max_yaw_acceleration_radps2 = 2.0,
                                  .window_s = 0.5};
  const VelocityWindow window = reachable_window(settings, 0.4, 0.1);
  EXPECT_NEAR(window.min_speed_mps, 0.4 - 0.6 * 0.5, kExactTol);
  EXPECT_NEAR(window.max_speed_mps, 0.4 + 0.2 * 0.5, kExactTol);
  EXPECT_NEAR(window.min_yaw_rate_radps, 0.1 - 1.0 * 0.5, kExactTol);
  EXPECT_NEAR(window.max_yaw_rate_radps, 0.1 + 2.0 * 0.5, kExactTol);
}

TEST(DwaLiu21, TheIntersectionKeepsBoth) {
  const VelocityWindow both = intersect({0.0, 0.8, -0.6, 0.6}, {-0.1, 0.2, -0.9, 0.1});
  EXPECT_EQ(both.min_speed_mps, 0.0);
  EXPECT_EQ(both.max_speed_mps, 0.2);
  EXPECT_EQ(both.min_yaw_rate_radps, -0.6);
  EXPECT_EQ(both.max_yaw_rate_radps, 0.1);
}

// 0.25 m before an obstacle: v <= sqrt(2 x 0.25 x 0.5) = 0.5 m/s, omega <= sqrt(2 x 0.25 x 0.72) = 0.6 rad/s.
TEST(DwaLiu21, Equation4LetsItStopBeforeTheObstacle) {
  const DwaLiu21Settings settings{.max_deceleration_mps2 = 0.5, .max_yaw_deceleration_radps2 = 0.72};
  EXPECT_TRUE(can_stop(settings, 0.499, 0.0, 0.25));
  EXPECT_FALSE(can_stop(settings, 0.501, 0.0, 0.25));
  EXPECT_TRUE(can_stop(settings, 0.0, -0.599, 0.25));
  EXPECT_FALSE(can_stop(settings, 0.0, -0.601, 0.25));
  EXPECT_TRUE(can_stop(settings, 0.0, 0.0, -0.1));  // at an obstacle it may stand
  EXPECT_FALSE(can_stop(settings, 0.01, 0.0, 0.0));
}

TEST(DwaLiu21, Equation6FallsFromOneAheadToZeroBehind) {
  EXPECT_NEAR(heading_term(0.0), 1.0, kExactTol);
  EXPECT_NEAR(heading_term(pi / 2.0), 0.5, kExactTol);
  EXPECT_NEAR(heading_term(-pi / 2.0), 0.5, kExactTol);
  EXPECT_NEAR(heading_term(pi), 0.0, kExactTol);
  EXPECT_NEAR(heading_term(2.0 * pi + 0.3), 1.0 - 0.3 / pi, kExactTol);
}

TEST(DwaLiu21, Equation7IsTheShareOfTheTopSpeed) {
  EXPECT_NEAR(velocity_term({.max_speed_mps = 0.8}, 0.2), 0.25, kExactTol);
}

TEST(DwaLiu21, NormalisedTermsSumToOne) {
  std::vector<double> values{1.0, 3.0, 4.0}, zeros{0.0, 0.0};
  normalize(values);
  EXPECT_THAT(values, ::testing::ElementsAre(0.125, 0.375, 0.5));
  normalize(zeros);
  EXPECT_THAT(zeros, ::testing::ElementsAre(0.0, 0.0));
}

/// 12 m by 12 m about the origin, free but for a block.
Costmap make_costmap(double x_min, double y_min, double x_max, double y_max) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 120, .height = 120, .origin_m = {-6.0, -6.0}}, kFree);
  for (double x = x_min + 0.05; x < x_max; x += 0.1) {
    for (double y = y_min + 0.05; y < y_max; y += 0.1) map.at(map.geometry().cell_at({x, y})) = kOccupied;
  }
  Costmap costmap({}, Footprint({{-0.5, -0.35}, {0.5, -0.35}, {0.5, 0.35}, {-0.5, 0.35}}, 2), {});
  costmap.set_map(map);
  return costmap;
}

Twist3 moving(double vx_mps, double yaw_rate_radps = 0.0) {
  return {.linear = {vx_mps, 0.0, 0.0}, .angular = {0.0, 0.0, yaw_rate_radps}};
}

// Free ground, path and robot straight on: every term but the heading favours the fastest, and straight on is best for
// that.
TEST(DwaLiu21, OnAFreeStraightPathDrivesStraightOnAsFastAsItCan) {
  const Costmap costmap = make_costmap(0.0, 0.0, 0.0, 0.0);
  const PlannedPath path({{-4.0, 0.0}, {5.0, 0.0}});
  const auto command = DwaLiu21({}).choose(costmap, path, 2.0, {-2.0, 0.0, 0.0}, moving(0.5), 10.0);
  ASSERT_TRUE(command);
  EXPECT_NEAR(command->vx_mps, 0.5 + 0.5 * 0.3, kExactTol);
  EXPECT_NEAR(command->yaw_rate_radps, 0.0, kExactTol);
  EXPECT_EQ(command->vy_mps, 0.0);
}

TEST(DwaLiu21, TurnsToATargetOnEitherSide) {
  const Costmap costmap = make_costmap(0.0, 0.0, 0.0, 0.0);
  const auto left = DwaLiu21({}).choose(costmap, PlannedPath({{0.0, 0.0}, {0.0, 4.0}}), 0.0, {}, moving(0.2), 10.0);
  const auto right = DwaLiu21({}).choose(costmap, PlannedPath({{0.0, 0.0}, {0.0, -4.0}}), 0.0, {}, moving(0.2), 10.0);
  ASSERT_TRUE(left && right);
  EXPECT_GT(left->yaw_rate_radps, 0.1);
  EXPECT_NEAR(right->yaw_rate_radps, -left->yaw_rate_radps, kExactTol);
}

TEST(DwaLiu21, KeepsTheSpeedLimit) {
  const Costmap costmap = make_costmap(0.0, 0.0, 0.0, 0.0);
  const auto command = DwaLiu21({}).choose(costmap, PlannedPath({{0.0, 0.0}, {4.0, 0.0}}), 0.0, {}, moving(0.2), 0.25);
  ASSERT_TRUE(command);
  EXPECT_LE(command->vx_mps, 0.25 + kExactTol);
}

// The path leads into a block; eq. 4 stops the robot before it.
TEST(DwaLiu21, StopsBeforeABlockOnThePath) {
  const Costmap costmap = make_costmap(2.0, -3.0, 2.5, 3.0);
  const PlannedPath path({{-4.0, 0.0}, {5.0, 0.0}});
  const DwaLiu21 planner({});
  Pose2 T_map_body{-2.0, 0.0, 0.0};
  VelocityCommand command;
  for (int tick = 0; tick < 300; ++tick) {
    const double along_m = path.project(T_map_body.position(), 0.0, 9.0).along_m;
    command = planner.choose(costmap, path, along_m, T_map_body, moving(command.vx_mps, command.yaw_rate_radps), 10.0)
                  .value_or(VelocityCommand{});
    T_map_body = follow_arc(T_map_body, command.vx_mps, command.yaw_rate_radps, 0.05);
    ASSERT_GT(costmap.clearance_m(T_map_body), 0.0) << "tick " << tick;
  }
  EXPECT_LT(T_map_body.x, 1.5);
}

TEST(DwaLiu21, RefusesSettingsThatBreakTheirRule) {
  EXPECT_THAT([] { DwaLiu21({.window_s = 0.0}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("dwa_liu21.window_s = 0")));
}

}  // namespace
}  // namespace patrol::plan::paper_dwa_test
