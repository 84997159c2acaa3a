#include "sim/locomotion/wheel_controller.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/urdf.h"
#include "sim/locomotion/roller_contact.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim {
namespace {

constexpr double kTick_s = 0.002;
constexpr double kTicksPerRad = 16384.0 / (2.0 * M_PI);

RobotDescription describe(const test::UrdfRobot& robot) {
  return io::load_robot_description(test::TemporaryFile("robot.urdf", robot.text()).path());
}

/// A robot on a test stand: each joint has the given inertia and no load.
struct Stand {
  explicit Stand(const RobotDescription& robot, double inertia_kgm2 = 1.0, const WheelDriveSettings& settings = {})
      : controller(robot, settings, kTicksPerRad, kTick_s), inertia(inertia_kgm2) {
    joints.position_rad.assign(robot.joint_names.size(), 0.0);
    joints.velocity_radps.assign(robot.joint_names.size(), 0.0);
    imu.linear_acceleration_mps2 = {0.0, 0.0, 9.81};
  }
  WheelDriveCommand run(double vx_mps, double yaw_rate_radps, double duration_s, double vy_mps = 0.0) {
    WheelDriveCommand command;
    for (double t = 0.0; t < duration_s; t += kTick_s) {
      command = controller.step(imu, joints,
                                {.stamp = {}, .vx_mps = vx_mps, .vy_mps = vy_mps, .yaw_rate_radps = yaw_rate_radps});
      for (std::size_t joint = 0; joint < joints.position_rad.size(); ++joint) {
        joints.velocity_radps[joint] += kTick_s * command.torque_nm[joint] / inertia;
        joints.position_rad[joint] += kTick_s * joints.velocity_radps[joint];
      }
    }
    return command;
  }

  WheelController controller;
  double inertia;
  Imu imu;
  JointState joints;
};

TEST(WheelController, AllWheelsReachTheSpeedOfTheCommandTo1Percent) {
  Stand stand(describe(test::skid_steer_urdf(0.5, 0.6)), 0.3);
  stand.run(0.6, 0.0, 3.0);
  EXPECT_THAT(stand.joints.velocity_radps, ::testing::Each(::testing::DoubleNear(0.6 / 0.15, 0.04)));
}

TEST(WheelController, AMotorAtItsSpeedLimitSlowsAllWheelsSoThatTheCurvatureStays) {
  test::UrdfRobot description = test::skid_steer_urdf(0.5, 0.6);
  description.speed_radps = 5.0;
  WheelDriveSettings settings;
  settings.effective_gauge_factor = 1.0;
  Stand stand(describe(description), 0.3, settings);
  stand.run(0.6, 1.0, 6.0);  // 0.3 m/s left and 0.9 m/s right would be 2 and 6 rad/s
  const auto& speeds = stand.joints.velocity_radps;
  const double left = std::min(speeds[0], speeds[1]), right = std::max(speeds[0], speeds[1]);
  EXPECT_NEAR(right, 5.0, 0.05);
  EXPECT_NEAR(left / right, 1.0 / 3.0, 0.02);
}

// Front left, front right, rear left, rear right; the order of the wheels of skid_steer_urdf.
TEST(WheelController, MecanumWheelsTurnAgainstEachOtherAtTheLimitOf0_5MetersPerSecondForACommandOf2ToTheLeft) {
  RobotDescription robot = describe(test::skid_steer_urdf(0.5, 0.6));
  WheelDriveSettings settings;
  settings.type = "mecanum";
  set_drive_type(settings, robot);
  Stand stand(robot, 0.3, settings);
  stand.run(0.0, 0.0, 3.0, 2.0);
  using ::testing::DoubleNear;
  const double w = 0.5 / 0.15;
  EXPECT_THAT(stand.joints.velocity_radps, ::testing::ElementsAre(DoubleNear(-w, 0.04), DoubleNear(w, 0.04),
                                                                  DoubleNear(w, 0.04), DoubleNear(-w, 0.04)));
  Stand other(describe(test::skid_steer_urdf(0.5, 0.6)), 0.3);
  other.run(0.0, 0.0, 1.0, 2.0);
  EXPECT_THAT(other.joints.velocity_radps, ::testing::Each(DoubleNear(0.0, 1e-6)));
}

TEST(WheelController, TheBrakesCloseHalfASecondAfterRestAndOpenOnCommand) {
  Stand stand(describe(test::skid_steer_urdf(0.5, 0.6)), 0.3);
  EXPECT_FALSE(stand.run(0.0, 0.0, 0.4).is_brake_closed);
  EXPECT_TRUE(stand.run(0.0, 0.0, 0.2).is_brake_closed);
  EXPECT_FALSE(stand.run(0.5, 0.0, 0.1).is_brake_closed);
}

TEST(WheelController, SteeringReachesItsAngleAtTheSpeedOfItsJointWithoutOvershoot) {
  const RobotDescription robot = describe(test::ackermann_urdf(1.0, 0.6, 0.5));
  Stand stand(robot, rotor_inertia_kgm2(robot, {}, 2));
  stand.run(0.5, 0.2, 3.0);  // a circle of 2.5 m
  EXPECT_NEAR(stand.joints.position_rad[2], std::atan(1.0 / 2.2), 0.01);
  EXPECT_NEAR(stand.joints.position_rad[3], std::atan(1.0 / 2.8), 0.01);
  EXPECT_NEAR(stand.joints.velocity_radps[2], 0.0, 0.01);
}

TEST(WheelController, GainsFollowFromTheMassSoThatARobotOf2KilogramsAndOneOf200AreStable) {
  for (const double mass_kg : {2.0, 200.0}) {
    test::UrdfRobot description = test::skid_steer_urdf(0.5, 0.6);
    description.mass_kg = mass_kg;
    description.effort_nm = 2.0 * mass_kg;
    const RobotDescription robot = describe(description);
    Stand stand(robot, 1.2 * robot.mass_kg / 4.0 * 0.15 * 0.15);
    stand.run(0.5, 0.0, 3.0);
    EXPECT_THAT(stand.joints.velocity_radps, ::testing::Each(::testing::DoubleNear(0.5 / 0.15, 0.03))) << mass_kg;
  }
}

TEST(WheelController, ReportsAFallAndRefusesSettingsOutOfRange) {
  const RobotDescription robot = describe(test::skid_steer_urdf(0.5, 0.6));
  Stand stand(robot);
  stand.run(0.0, 0.0, 1.0);
  EXPECT_FALSE(stand.controller.has_fallen());
  stand.imu.linear_acceleration_mps2 = {0.0, 9.81, 0.0};
  stand.run(0.0, 0.0, 8.0);
  EXPECT_TRUE(stand.controller.has_fallen());
  WheelDriveSettings settings;
  settings.tire_deflection_ratio = 0.0;
  EXPECT_THROW(WheelController(robot, settings, kTicksPerRad), InputError);
}

}  // namespace
}  // namespace patrol::sim
