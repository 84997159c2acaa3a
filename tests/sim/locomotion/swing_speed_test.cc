#include "sim/locomotion/swing_speed.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "io/urdf.h"
#include "sim/locomotion/leg_gains.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::swing_speed_test {
namespace {

/// Quadruped with thighs and shanks of the same length below its hips, whose joints have the same speed limit.
RobotDescription even_legged_robot(double limit_radps, double link_m = 0.2) {
  const test::TemporaryFile urdf("robot.urdf", test::UrdfQuadruped{.thigh_m = link_m, .shank_m = link_m}.text());
  RobotDescription robot = io::load_robot_description(urdf.path());
  for (JointLimit& limit : robot.joint_limits) limit.velocity_radps = limit_radps;
  return robot;
}

/// Speed of a knee whose foot, below the hip, is at height -h and moves up at a speed: h = 2 l cos(knee / 2).
double knee_radps(double h_m, double up_mps) {
  constexpr double kLink_m = 0.2;
  return 2.0 * up_mps / (2.0 * kLink_m * std::sqrt(1.0 - std::pow(h_m / (2.0 * kLink_m), 2)));
}

TEST(SwingSpeed, OfAFootThatIsLiftedBelowTheHipIsTheClosedFormOfTheKnee) {
  const LocomotionSettings settings{
      .gait_period_s = 0.5, .gait_duty = 0.6, .trunk_height_m = 0.3, .swing_clearance_m = 0.05};
  double peak_radps = 0.0;
  for (int i = 0; i <= 40; ++i) {  // the samples of the rise: 40 % of the swing of 0.2 s
    const double raised = i / 40.0 / 0.4;
    if (raised > 1.0) break;
    const double h_m = 0.3 - 0.05 * (1.0 - std::cos(std::numbers::pi * raised)) / 2.0;
    const double up_mps = 0.05 * std::numbers::pi * std::sin(std::numbers::pi * raised) / (2.0 * 0.4 * 0.2);
    peak_radps = std::max(peak_radps, knee_radps(h_m, up_mps));
  }
  EXPECT_NEAR(peak_swing_speed_ratio(even_legged_robot(10.0), settings, 0.0), peak_radps / 10.0, 1e-3);
}

TEST(SwingSpeed, GrowsWithTheSpeedOfTheRobotAndWithTheClearance) {
  const RobotDescription robot = even_legged_robot(20.0);
  LocomotionSettings settings = scaled_locomotion(even_legged_robot(1000.0));
  const double slow = peak_swing_speed_ratio(robot, settings, 0.1);
  EXPECT_GT(peak_swing_speed_ratio(robot, settings, 1.0), 1.02 * slow);
  settings.swing_clearance_m *= 0.5;
  EXPECT_LT(peak_swing_speed_ratio(robot, settings, 0.1), 0.75 * slow);
}

TEST(SwingSpeed, SlowJointsLowerTheSwingThenLengthenThePeriodThenSlowTheRobot) {
  constexpr double kLink_m = 0.4;  // the lowest swing is higher than steps require
  const RobotDescription fast_robot = even_legged_robot(1000.0, kLink_m);
  const LocomotionSettings fast = scaled_locomotion(fast_robot);
  const RobotDescription slow_robot = even_legged_robot(
      1000.0 * peak_swing_speed_ratio(fast_robot, fast, fast.max_forward_mps), kLink_m);  // a ratio of 1
  const LocomotionSettings slow = scaled_locomotion(slow_robot);
  EXPECT_LT(slow.swing_clearance_m, 0.95 * fast.swing_clearance_m);
  EXPECT_EQ(slow.max_forward_mps, fast.max_forward_mps);
  EXPECT_EQ(slow.gait_period_s, fast.gait_period_s);
  EXPECT_NEAR(peak_swing_speed_ratio(slow_robot, slow, slow.max_forward_mps), 0.82, 1e-3);

  RobotDescription slower_robot = slow_robot;
  const auto slowed_to = [&](double ratio) {
    for (std::size_t i = 0; i < slower_robot.joint_limits.size(); ++i)
      slower_robot.joint_limits[i].velocity_radps = ratio * slow_robot.joint_limits[i].velocity_radps;
    const LocomotionSettings slower = scaled_locomotion(slower_robot);
    EXPECT_NEAR(slower.swing_clearance_m, 0.6 * fast.swing_clearance_m, 1e-12) << ratio;
    return slower;
  };
  const LocomotionSettings slower = slowed_to(0.75);
  EXPECT_EQ(slower.gait_period_s, fast.gait_period_s) << "fast enough for 35 % of the speed";
  EXPECT_LT(slower.max_forward_mps, 0.9 * fast.max_forward_mps);
  EXPECT_GT(slower.max_forward_mps, 0.35 * fast.max_forward_mps);
  const LocomotionSettings slowest = slowed_to(0.6);
  EXPECT_GT(slowest.gait_period_s, 1.05 * fast.gait_period_s);
  EXPECT_NEAR(slowest.max_forward_mps, 0.35 * fast.max_forward_mps, 1e-3);
  EXPECT_NEAR(peak_swing_speed_ratio(slower_robot, slowest, slowest.max_forward_mps), 0.82, 1e-3);
  const LocomotionSettings least = slowed_to(0.4);
  EXPECT_NEAR(least.gait_period_s, 1.5 * fast.gait_period_s, 1e-9);
  EXPECT_LT(least.max_forward_mps, 0.35 * fast.max_forward_mps);
}

TEST(SwingSpeed, TheClearanceIs8CentimetersOr27PercentOfTheLegUnlessTheJointsAreMuchTooSlow) {
  EXPECT_NEAR(scaled_locomotion(even_legged_robot(1000.0, 0.15)).swing_clearance_m, 0.08, 1e-9);
  EXPECT_NEAR(scaled_locomotion(even_legged_robot(1000.0, 0.1)).swing_clearance_m, 0.054, 1e-9);
  const RobotDescription robot = even_legged_robot(20.0, 0.15), slower_robot = even_legged_robot(15.0, 0.15);
  const LocomotionSettings settings = scaled_locomotion(robot), slower = scaled_locomotion(slower_robot);
  EXPECT_NEAR(settings.swing_clearance_m, 0.08, 1e-6);
  const double full_mps = std::sqrt(0.3 / 0.426);  // that of the tuned robot at an equal Froude number
  EXPECT_NEAR(scaled_locomotion(even_legged_robot(1000.0, 0.15)).max_forward_mps, 0.09 * 0.3 / 0.426 / 0.08 * full_mps,
              1e-3);
  EXPECT_LT(settings.max_forward_mps, 0.79 * full_mps);
  EXPECT_GT(settings.max_forward_mps, 0.45 * full_mps);
  EXPECT_LT(peak_swing_speed_ratio(robot, settings, settings.max_forward_mps), 1.4);
  EXPECT_LT(slower.swing_clearance_m, 0.079);
  EXPECT_GT(slower.swing_clearance_m, min_swing_clearance_m(slower_robot));
  const double peak = peak_swing_speed_ratio(slower_robot, slower, slower.max_forward_mps);
  EXPECT_GT(peak, 1.25) << "1.4 at the speed before it was lowered";
  EXPECT_LT(peak, 1.4);
  const RobotDescription slowest_robot = even_legged_robot(3.0, 0.15);
  EXPECT_NEAR(scaled_locomotion(slowest_robot).swing_clearance_m, min_swing_clearance_m(slowest_robot), 1e-12);
}

TEST(SwingSpeed, TheJointsOfTheFirstQuadrupedAreFastEnough) {
  const LocomotionSettings scaled = scaled_locomotion(io::load_robot_description(kRobotUrdf)), tuned;
  EXPECT_EQ(scaled.swing_clearance_m, tuned.swing_clearance_m);
  EXPECT_EQ(scaled.max_forward_mps, tuned.max_forward_mps);
  EXPECT_EQ(scaled.gait_period_s, tuned.gait_period_s);
}

}  // namespace
}  // namespace patrol::sim::swing_speed_test
