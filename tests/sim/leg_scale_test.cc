#include "sim/leg_scale.h"

#include <gtest/gtest.h>

#include "io/urdf.h"
#include "tests/support/simulated_quadruped.h"

namespace patrol::sim::leg_scale_test {
namespace {

TEST(LegScale, OfTheTunedRobotIsOneExactly) {
  const RobotDescription robot = io::load_robot_description(kRobotUrdf);
  const LegScale scale = leg_scale(robot);
  EXPECT_EQ(scale.length, 1.0);
  EXPECT_EQ(scale.time, 1.0);
  EXPECT_EQ(scale.force, 1.0);
  EXPECT_EQ(motor_ratio(robot, 0), 1.0);
  EXPECT_EQ(motor_ratio(robot, 2), 1.5);
}

TEST(LegScale, OfAHeavyRobotWithLongLegsFollowsTheFroudeNumberAndTheMass) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  for (LegGeometry& leg : robot.legs) leg.thigh_m *= 2.25, leg.shank_m *= 2.25;
  robot.mass_kg *= 5.0;
  const LegScale scale = leg_scale(robot);
  EXPECT_NEAR(scale.length, 2.25, 1e-12);
  EXPECT_NEAR(scale.time, 1.5, 1e-12);
  EXPECT_EQ(scale.force, 5.0);
}

TEST(LegScale, AMotorCountsUpTo3TimesTheTorqueOfWeightTimesLegLength) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  robot.joint_limits[0].effort_nm = 2.0 * 23.7;
  EXPECT_NEAR(motor_ratio(robot, 0), 2.0, 1e-12);
  robot.joint_limits[0].effort_nm = 1000.0;
  EXPECT_NEAR(motor_ratio(robot, 0), 3.0, 1e-12);
}

}  // namespace
}  // namespace patrol::sim::leg_scale_test
