#include "sim/locomotion/quadruped_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "tests/support/simulated_quadruped.h"

namespace patrol::sim::quadruped_controller_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A robot on the plane that has found its stance.
WalkingRobot standing_robot(const std::string& geoms = "") {
  WalkingRobot robot(make_flat_world(geoms));
  robot.stand(1.0);
  return robot;
}

TEST(QuadrupedController, StandsFiveSecondsWithin1CentimetreAnd1DegreeWithoutAStep) {
  WalkingRobot robot = standing_robot();
  const WalkReport report = robot.stand(5.0);
  EXPECT_LT(report.moved.position().norm(), 0.01);
  EXPECT_LT(std::abs(report.moved.yaw), 0.02);
  EXPECT_LT(report.max_tilt_rad, kDegree);
  EXPECT_NEAR(report.min_height_m, 0.32, 0.03);
  EXPECT_EQ(report.steps_taken, 0);
  EXPECT_FALSE(report.has_fallen);
}

// A heading held by the gyro would turn the trunk by 15 degrees against its feet.
TEST(QuadrupedController, StandsThirtySecondsWithin1DegreeWithAGyroBiasOfHalfADegreePerSecond) {
  WalkingRobot robot = standing_robot();
  robot.add_gyro_bias(to_rad(0.5));
  const WalkReport report = robot.stand(30.0);
  EXPECT_LT(std::abs(report.moved.yaw), kDegree);
  EXPECT_LT(report.moved.position().norm(), 0.05);
  EXPECT_LT(report.max_tilt_rad, 2.0 * kDegree);
  EXPECT_FALSE(report.has_fallen);
}

// Before, the trunk moved 0.13 m off its feet while the estimator settled, and fell over the first pair of feet.
TEST(QuadrupedController, WakesUpAndStandsWithin4CentimetersAndStartsToWalkWithAVerticalTiltedBy2Degrees) {
  for (const double angle_rad : {0.0, 0.25 * kPi, 0.5 * kPi, 0.75 * kPi, kPi, 1.25 * kPi, 1.5 * kPi, 1.75 * kPi}) {
    SCOPED_TRACE(angle_rad);
    WalkingRobot robot(make_flat_world());
    robot.add_accelerometer_bias(9.81 * std::sin(2.0 * kDegree) *
                                 Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0.0));
    const WalkReport standing = robot.stand(4.0);
    EXPECT_LT(standing.moved.position().norm(), 0.04);
    EXPECT_LT(standing.max_tilt_rad, 4.0 * kDegree);
    EXPECT_EQ(standing.steps_taken, 0);
    const WalkReport start = robot.walk(0.8, 0.0, 0.1, 2.0);
    EXPECT_LT(start.max_tilt_rad, 15.0 * kDegree);
    EXPECT_LT(std::abs(start.moved.y), 0.2);
    EXPECT_FALSE(start.has_fallen);
  }
}

struct Walk {
  const char* name;
  double vx_mps, vy_mps, yaw_rate_radps;
};

void PrintTo(const Walk& walk, std::ostream* out) { *out << walk.name; }

class Walking : public testing::TestWithParam<Walk> {};

TEST_P(Walking, FollowsTheCommandWithin10PercentAnd0_03AndKeepsItsTrunkLevel) {
  const Walk& walk = GetParam();
  WalkingRobot robot = standing_robot();
  robot.walk(walk.vx_mps, walk.vy_mps, walk.yaw_rate_radps, 2.0);  // up to speed
  const WalkReport report = robot.walk(walk.vx_mps, walk.vy_mps, walk.yaw_rate_radps, 4.0);
  EXPECT_NEAR(report.mean_forward_mps, walk.vx_mps, 0.1 * std::abs(walk.vx_mps) + 0.03);
  EXPECT_NEAR(report.mean_sideways_mps, walk.vy_mps, 0.1 * std::abs(walk.vy_mps) + 0.05);
  EXPECT_NEAR(report.mean_yaw_rate_radps, walk.yaw_rate_radps, 0.1 * std::abs(walk.yaw_rate_radps) + 0.03);
  EXPECT_LT(report.roll_rms_rad, 0.06);
  EXPECT_LT(report.pitch_rms_rad, 0.06);
  EXPECT_LT(report.max_tilt_rad, 0.25);
  EXPECT_GT(report.min_height_m, 0.26);
  EXPECT_LT(report.slip_mps, 0.12);  // feet do not skate
  EXPECT_LE(report.max_torque_nm, 45.5);
  EXPECT_GE(report.steps_taken, 20);
  EXPECT_FALSE(report.has_fallen);
}

INSTANTIATE_TEST_SUITE_P(QuadrupedController, Walking,
                         testing::Values(Walk{"forward_0_5_mps", 0.5, 0.0, 0.0}, Walk{"forward_1_mps", 1.0, 0.0, 0.0},
                                         Walk{"backward_0_3_mps", -0.3, 0.0, 0.0},
                                         Walk{"turn_left_1_radps", 0.0, 0.0, 1.0},
                                         Walk{"turn_right_1_radps", 0.0, 0.0, -1.0}, Walk{"curve", 0.5, 0.0, 0.5}),
                         [](const testing::TestParamInfo<Walk>& walk) { return std::string(walk.param.name); });

TEST(QuadrupedController, StopsWithin0_8SecondsOfWalkingHalfAMetreASecondAndStands) {
  WalkingRobot robot = standing_robot();
  robot.walk(0.5, 0.0, 0.0, 3.0);
  robot.walk(0.0, 0.0, 0.0, 1.5);
  const WalkReport after = robot.stand(1.0);
  EXPECT_LT(after.moved.position().norm(), 0.02);
  EXPECT_EQ(after.steps_taken, 0);
}

// Feet that touch late, or not at all, are never on the ground together in a trot. It went on in place forever.
TEST(QuadrupedController, StopsTrottingWithin2SecondsThoughNoFootTouches) {
  const RobotDescription robot = io::load_robot_description(kRobotUrdf);
  QuadrupedController controller(robot, {});
  const Imu imu{.linear_acceleration_mps2 = {0.0, 0.0, 9.81}};
  JointState joints;
  for (const LegGeometry& leg : robot.legs)
    joints.position_rad.insert(joints.position_rad.end(), leg.standing_rad.begin(), leg.standing_rad.end());
  joints.velocity_radps.assign(joints.position_rad.size(), 0.0);
  const FootContacts loaded{.force_n = std::vector<double>(kNumLegs, 33.0)},
      unloaded{.force_n = std::vector<double>(kNumLegs, 0.0)};
  const auto change_of_torques_nm = [&](double duration_s, const FootContacts& feet, double vx_mps) {
    const LegSensors sensors{.imu = imu, .joints = joints, .feet = feet};
    const JointTorques first = controller.step(sensors, {.vx_mps = vx_mps});
    double change_nm = 0.0;
    for (int tick = 1; tick < duration_s / 0.002; ++tick)
      change_nm = std::max(change_nm, (controller.step(sensors, {.vx_mps = vx_mps}) - first).cwiseAbs().maxCoeff());
    return change_nm;
  };
  change_of_torques_nm(2.0, loaded, 0.0);
  EXPECT_GT(change_of_torques_nm(1.0, unloaded, 0.1), 3.0) << "it does not trot";
  change_of_torques_nm(2.0, unloaded, 0.0);
  EXPECT_LT(change_of_torques_nm(1.0, unloaded, 0.0), 0.5) << "it still trots";
}

TEST(QuadrupedController, TakesAKerbEdgeOf5CentimetresUpAndDownAgain) {
  WalkingRobot robot = standing_robot(R"(<geom type="box" pos="2.5 0 0.025" size="1.25 3 0.025"/>)");
  const WalkReport report = robot.walk(0.5, 0.0, 0.0, 11.0);
  EXPECT_FALSE(report.has_fallen);
  EXPECT_GT(report.moved.x, 4.6);  // beyond the far edge, at 3.75 m
  EXPECT_LT(std::abs(report.moved.y), 0.5);
  EXPECT_LT(report.max_tilt_rad, 0.5);
}

TEST(QuadrupedController, ClimbsASlopeOf5DegreesAndComesDownIt) {
  // A ridge: 5 degrees up over 3 m from x = 0.7 m, and as much down on the other side.
  const double angle = to_rad(5.0), length = 3.0;
  const auto ramp = [&](double foot_x, double sign) {
    const double x = foot_x + sign * (length / 2.0 * std::cos(angle)) + sign * 0.1 * std::sin(angle);
    const double z = length / 2.0 * std::sin(angle) - 0.1 * std::cos(angle);
    return "<geom type='box' size='" + std::to_string(length / 2.0) + " 3 0.1' pos='" + std::to_string(x) + " 0 " +
           std::to_string(z) + "' euler='0 " + std::to_string(-5.0 * sign) + " 0'/>";
  };
  const double ridge_x = 0.7 + length * std::cos(angle);
  WalkingRobot robot = standing_robot(ramp(0.7, 1.0) + ramp(2.0 * ridge_x - 0.7, -1.0));
  const WalkReport up = robot.walk(0.5, 0.0, 0.0, 6.5);
  EXPECT_FALSE(up.has_fallen);
  EXPECT_GT(robot.T_world_body().position.z(), 0.32 + 0.10);
  const WalkReport down = robot.walk(0.5, 0.0, 0.0, 9.0);
  EXPECT_FALSE(down.has_fallen);
  EXPECT_NEAR(robot.T_world_body().position.z(), 0.32, 0.05);
  EXPECT_GT(robot.T_world_body().position.x(), 6.5);
  EXPECT_LT(std::max(up.max_tilt_rad, down.max_tilt_rad), 0.35);
}

TEST(QuadrupedController, AFallIsDetectedWithin1SecondOfBeingToppled) {
  WalkingRobot robot = standing_robot();
  const int trunk = mj_name2id(&robot.model(), mjOBJ_BODY, frame_id::kBody);
  robot.data().xfrc_applied[6 * trunk + 3] = 80.0;  // N m, about x: rolled over by a hand
  robot.stand(0.4);
  robot.data().xfrc_applied[6 * trunk + 3] = 0.0;
  bool was_detected = false;  // at any instant: the robot rolls over, and it may be upright again for a moment
  for (int i = 0; i < 10; ++i) was_detected |= robot.stand(0.1).has_fallen;
  EXPECT_TRUE(was_detected);
}

TEST(QuadrupedController, APushOfSixNewtonSecondsAtTheTrunkIsNoFall) {
  WalkingRobot robot = standing_robot();
  robot.data().qvel[1] += 0.4;  // 15 kg x 0.4 m/s sideways
  EXPECT_FALSE(robot.walk(0.3, 0.0, 0.0, 3.0).has_fallen);
}

TEST(QuadrupedController, ItsOwnVelocityIsWithin8CentimetresPerSecondRmsAt0_5MetresPerSecond) {
  WalkingRobot robot = standing_robot();
  robot.walk(0.5, 0.0, 0.0, 2.0);
  EXPECT_LT(robot.walk(0.5, 0.0, 0.0, 3.0).velocity_error_mps, 0.08);
}

TEST(QuadrupedController, TwoRobotsOfTheSameSeedWalkToTheSameBit) {
  WalkingRobot first = standing_robot(), second = standing_robot();
  first.walk(0.5, 0.0, 0.2, 1.0);
  second.walk(0.5, 0.0, 0.2, 1.0);
  for (int i = 0; i < first.model().nq; ++i) EXPECT_EQ(first.data().qpos[i], second.data().qpos[i]) << i;
}

}  // namespace
}  // namespace patrol::sim::quadruped_controller_test
