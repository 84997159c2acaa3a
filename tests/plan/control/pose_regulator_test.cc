#include "plan/control/pose_regulator.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::pose_regulator_test {
namespace {

constexpr double kExactTol = 1e-12;

// In body the goal lies 0.1 m ahead and 0.05 m to the left, 0.2 rad on.
TEST(PoseRegulator, CommandsGainTimesErrorInTheBodyFrame) {
  const Pose2 T_map_body{3.0, -2.0, 2.0};
  const NavigationGoal goal{.T_map_body = T_map_body * Pose2{0.1, 0.05, 0.2}};
  const PoseRegulatorSettings settings{.position_gain_per_s = 1.2, .yaw_gain_per_s = 1.5};
  const VelocityCommand command = regulate_pose(settings, T_map_body, goal);
  EXPECT_NEAR(command.vx_mps, 1.2 * 0.1, kExactTol);
  EXPECT_NEAR(command.vy_mps, 1.2 * 0.05, kExactTol);
  EXPECT_NEAR(command.yaw_rate_radps, 1.5 * 0.2, kExactTol);
}

TEST(PoseRegulator, KeepsItsLimitsInEveryDirection) {
  const PoseRegulatorSettings settings{.max_speed_mps = 0.25, .max_lateral_speed_mps = 0.15, .max_yaw_rate_radps = 0.6};
  const VelocityCommand plus = regulate_pose(settings, {}, {.T_map_body = {9.0, 9.0, 3.0}});
  EXPECT_EQ(plus.vx_mps, 0.25);
  EXPECT_EQ(plus.vy_mps, 0.15);
  EXPECT_EQ(plus.yaw_rate_radps, 0.6);
  const VelocityCommand minus = regulate_pose(settings, {}, {.T_map_body = {-9.0, -9.0, -3.0}});
  EXPECT_EQ(minus.vx_mps, -0.25);
  EXPECT_EQ(minus.vy_mps, -0.15);
  EXPECT_EQ(minus.yaw_rate_radps, -0.6);
}

TEST(PoseRegulator, TurnsTheShortWayAcrossPi) {
  const VelocityCommand command = regulate_pose({}, {0.0, 0.0, 3.1}, {.T_map_body = {0.0, 0.0, -3.1}});
  EXPECT_NEAR(command.yaw_rate_radps, 1.5 * (2.0 * std::numbers::pi - 6.2),
              1e-9);  // 0.083 rad counter-clockwise
}

TEST(PoseRegulator, DoesNotTurnWhereAnyHeadingWillDo) {
  for (const double tolerance_rad : {3.0, 3.1, std::numbers::pi}) {
    const NavigationGoal goal{.T_map_body = {1.0, 0.0, 2.0}, .yaw_tolerance_rad = tolerance_rad};
    EXPECT_EQ(regulate_pose({}, {}, goal).yaw_rate_radps, 0.0) << tolerance_rad;
  }
}

TEST(PoseRegulator, AtTheGoalStands) {
  const VelocityCommand command = regulate_pose({}, {1.0, 2.0, 3.0}, {.T_map_body = {1.0, 2.0, 3.0}});
  EXPECT_NEAR(command.vx_mps, 0.0, kExactTol);
  EXPECT_NEAR(command.vy_mps, 0.0, kExactTol);
  EXPECT_NEAR(command.yaw_rate_radps, 0.0, kExactTol);
}

// The gain of 1.2 per second takes 1 cm from half a metre within ln(50) / 1.2 = 3.3 s, the speed limit
// another second or two.
TEST(PoseRegulator, ReachesAHundredRandomGoalsToACentimetre) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    const RandomStream stream(i, "test/goal");
    const NavigationGoal goal{
        .T_map_body = {stream.uniform(0) - 0.5, stream.uniform(1) - 0.5, 6.28 * stream.uniform(2)},
        .position_tolerance_m = 0.01,
        .yaw_tolerance_rad = 0.01};
    Pose2 T_map_body;
    for (int step = 0; step < 200 && !is_reached(T_map_body, goal); ++step) {
      const VelocityCommand command = regulate_pose({}, T_map_body, goal);
      T_map_body = T_map_body * Pose2{0.05 * command.vx_mps, 0.05 * command.vy_mps, 0.05 * command.yaw_rate_radps};
    }
    ASSERT_TRUE(is_reached(T_map_body, goal)) << "goal " << i << ", at " << T_map_body.vector().transpose();
  }
}

TEST(PoseRegulator, ReachedMeansBothPositionAndHeading) {
  const NavigationGoal goal{.T_map_body = {1.0, 1.0, 3.1}, .position_tolerance_m = 0.05, .yaw_tolerance_rad = 0.1};
  EXPECT_TRUE(is_reached({1.02, 0.96, 3.1}, goal));   // 4.5 cm off
  EXPECT_FALSE(is_reached({1.04, 0.96, 3.1}, goal));  // 5.7 cm
  EXPECT_TRUE(is_reached({1.0, 1.0, -3.1}, goal));    // 0.083 rad across pi
  EXPECT_FALSE(is_reached({1.0, 1.0, -3.0}, goal));   // 0.183 rad
}

TEST(PoseRegulator, AnyHeadingWillDoFromAToleranceOfThreeRadOn) {
  for (const double tolerance_rad : {3.0, 3.1, std::numbers::pi}) {
    const NavigationGoal goal{.T_map_body = {1.0, 1.0, 0.0}, .yaw_tolerance_rad = tolerance_rad};
    EXPECT_TRUE(is_reached({1.0, 1.0, std::numbers::pi}, goal)) << tolerance_rad;
  }
  EXPECT_FALSE(is_reached({1.0, 1.0, std::numbers::pi}, {.T_map_body = {1.0, 1.0, 0.0}, .yaw_tolerance_rad = 2.9}));
}

}  // namespace
}  // namespace patrol::plan::pose_regulator_test
