#include "plan/control/differential_pose_controller.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "tests/plan/tracked_plant.h"

namespace patrol::plan::differential_approach_test {
namespace {

using std::numbers::pi;

constexpr double kPeriod_s = 0.05;

struct ApproachRecord {
  bool is_done = false;
  double time_s = 0.0;
  double way_m = 0.0;
  Pose2 T_goal_body;
};

/// Until the approach is done; then for a second more, while the commands under way take effect.
ApproachRecord approach(TrackedPlant plant, const NavigationGoal& goal, double timeout_s, double pose_std_m = 0.0) {
  DifferentialPoseController regulator({});
  const RandomStream noise(3, "test/pose");
  ApproachRecord record;
  int ticks_after = 0;
  const auto ticks = static_cast<std::uint64_t>(timeout_s / kPeriod_s);
  for (std::uint64_t tick = 0; tick < ticks && ticks_after < 20; ++tick) {
    const Pose2 error{pose_std_m * noise.normal(tick, 0), pose_std_m * noise.normal(tick, 1),
                      pose_std_m * noise.normal(tick, 2)};
    const VelocityCommand command = regulator.step(plant.T_map_body * error, goal);
    EXPECT_EQ(command.vy_mps, 0.0);
    const Eigen::Vector2d before = plant.T_map_body.position();
    plant.move(command, kPeriod_s);
    record.way_m += (plant.T_map_body.position() - before).norm();
    if (!regulator.is_done()) record.time_s = kPeriod_s * static_cast<double>(tick);
    ticks_after += regulator.is_done();
  }
  record.is_done = regulator.is_done();
  record.T_goal_body = goal.T_map_body.inverse() * plant.T_map_body;
  return record;
}

/// 2 cm and 1 degree.
NavigationGoal make_goal(const Pose2& T_map_body) {
  return {.T_map_body = T_map_body, .position_tolerance_m = 0.02, .yaw_tolerance_rad = kDegree};
}

/// A tolerance and what a command under way adds to it: 0.04 m/s and 0.08 rad/s for 0.05 s.
constexpr double kPositionTol_m = 0.02 + 0.002;
constexpr double kYawTol_rad = 1.0 * kDegree + 0.004;

// Anywhere within 0.8 m, any heading; slip 10-40 % in turning, turning about up to 5 cm from the body's origin, 50 ms
// late.
TEST(DifferentialPoseController, ReachesTwoHundredGoalsToTwoCentimetresAndOneDegreeInSpiteOfSlip) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomStream stream(seed, "test/goal");
    const double distance_m = 0.8 * stream.uniform(0), direction = 2.0 * pi * stream.uniform(1);
    const NavigationGoal goal = make_goal(
        {distance_m * std::cos(direction), distance_m * std::sin(direction), 2.0 * pi * stream.uniform(2) - pi});
    const TrackedPlant plant{.turn_slip = 0.1 + 0.3 * stream.uniform(3),
                             .way_slip = 0.05 * stream.uniform(4),
                             .turn_center_m = 0.1 * stream.uniform(5) - 0.05,
                             .T_map_body = {},
                             .on_the_way = {}};
    const ApproachRecord record = approach(plant, goal, 90.0);
    ASSERT_TRUE(record.is_done) << "seed " << seed << " at " << record.T_goal_body.vector().transpose();
    EXPECT_LE(record.T_goal_body.position().norm(), kPositionTol_m) << "seed " << seed;
    EXPECT_LE(std::abs(record.T_goal_body.yaw), kYawTol_rad) << "seed " << seed;
    EXPECT_LT(record.time_s, 45.0) << "seed " << seed;
    EXPECT_LT(record.way_m, distance_m + 2.5) << "seed " << seed;
  }
}

// 0.5 m straight on at 0.3 m/s and then slower: no turn, no detour.
TEST(DifferentialPoseController, AGoalStraightAheadIsDrivenToStraight) {
  const ApproachRecord record = approach({}, make_goal({0.5, 0.0, 0.0}), 30.0);
  EXPECT_TRUE(record.is_done);
  EXPECT_NEAR(record.way_m, 0.5, 0.011);
  EXPECT_LT(record.time_s, 8.0);
}

TEST(DifferentialPoseController, AGoalStraightBehindIsDrivenToBackwards) {
  const ApproachRecord record = approach({}, make_goal({-0.5, 0.0, 0.0}), 30.0);
  EXPECT_TRUE(record.is_done);
  EXPECT_NEAR(record.way_m, 0.5, 0.011);
  EXPECT_LT(record.time_s, 8.0);
}

// 5 cm aside with the right heading: back along the axis and in again. ln(5 / 0.5) / 3 = 0.77 m each way is what the
// law needs to leave half a centimetre.
TEST(DifferentialPoseController, AFewCentimetresAsideAreTakenOffByBackingUp) {
  const ApproachRecord record = approach({}, make_goal({0.0, 0.05, 0.0}), 60.0);
  EXPECT_TRUE(record.is_done);
  EXPECT_LE(record.T_goal_body.position().norm(), kPositionTol_m);
  EXPECT_GT(record.way_m, 0.6);
  EXPECT_LT(record.way_m, 1.8);
}

// The room behind is blocked: the way back and forth begins ahead instead.
TEST(DifferentialPoseController, WithNoRoomBehindShufflesAhead) {
  DifferentialPoseController regulator({});
  const NavigationGoal goal = make_goal({0.0, 0.05, 0.0});
  EXPECT_LT(regulator.step({}, goal).vx_mps, 0.0);
  regulator.block();
  EXPECT_GT(regulator.step({}, goal).vx_mps, 0.0);
}

TEST(DifferentialPoseController, WhereAnyHeadingWillDoItDoesNotTurnAtTheEnd) {
  const NavigationGoal goal{.T_map_body = {0.5, 0.0, 2.0}, .position_tolerance_m = 0.1, .yaw_tolerance_rad = pi};
  const ApproachRecord record = approach({}, goal, 30.0);
  EXPECT_TRUE(record.is_done);
  EXPECT_NEAR(record.T_goal_body.yaw, -2.0, 1e-3);
}

TEST(DifferentialPoseController, OnceDoneStandsUntilReset) {
  DifferentialPoseController regulator({});
  const NavigationGoal goal = make_goal({1.0, 1.0, 1.0});
  regulator.step({1.0, 1.0, 1.0}, goal);
  ASSERT_TRUE(regulator.is_done());
  const VelocityCommand drifted = regulator.step({0.7, 1.0, 1.0}, goal);
  EXPECT_EQ(drifted.vx_mps, 0.0);
  EXPECT_EQ(drifted.yaw_rate_radps, 0.0);
  regulator.reset();
  EXPECT_NE(regulator.step({0.7, 1.0, 1.0}, goal).yaw_rate_radps, 0.0);
}

// Localisation that jitters by 1 cm and 0.6 degrees from step to step.
TEST(DifferentialPoseController, AJitteringPoseDoesNotKeepItFromEnding) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const RandomStream stream(seed, "test/goal");
    const NavigationGoal goal =
        make_goal({0.6 * stream.uniform(0), 0.6 * stream.uniform(1) - 0.3, 6.28 * stream.uniform(2)});
    const ApproachRecord record = approach({}, goal, 90.0, 0.01);
    EXPECT_TRUE(record.is_done) << "seed " << seed;
    EXPECT_LE(record.T_goal_body.position().norm(), 0.06) << "seed " << seed;
  }
}

}  // namespace
}  // namespace patrol::plan::differential_approach_test
