#include "stack/localization/odometry_source.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/wheel_kinematics.h"

namespace patrol::stack::odometry_source_test {
namespace {

/// Robot with four driven wheels on level ground.
RobotDescription make_robot_on_wheels(bool is_mecanum) {
  RobotDescription robot;
  robot.name = "four_wheels";
  for (const double x : {0.2, -0.2}) {
    for (const double y : {0.25, -0.25}) {
      WheelGeometry wheel{.link = "w", .center_in_body = {x, y, 0.0}, .radius_m = 0.1};
      wheel.drive_joint = robot.joint_names.size();
      robot.joint_names.push_back("j");
      robot.joint_limits.push_back({.velocity_radps = 20.0, .effort_nm = 10.0});
      robot.wheels.push_back(wheel);
    }
  }
  robot.T_body_sensor["imu"] = {};
  if (is_mecanum) add_rollers(RollerPattern::kX, 0.25 * std::numbers::pi, robot);
  return robot;
}

JointState joints_at(double time_s, const std::vector<double>& position_rad) {
  return {.stamp = from_seconds(time_s), .position_rad = position_rad, .velocity_radps = {}, .effort_nm = {}};
}

/// Feeds a robot that stands for 4 s with one reading of its wheels each 20 ms.
void stand(OdometrySource& odometry, const std::vector<double>& position_rad) {
  for (int tick = 0; tick < 1000; ++tick) {
    const double dither = tick % 2 == 0 ? 1e-4 : -1e-4;  // equal readings are those of a frozen sensor
    odometry.add(Imu{.stamp = from_seconds(0.004 * tick),
                     .angular_velocity_radps = {0.0, 0.0, dither},
                     .linear_acceleration_mps2 = {dither, 0.0, 9.81}});
    if (tick % 5 == 0) odometry.add(joints_at(0.004 * tick, position_rad));
  }
}

TEST(OdometrySource, WheelReadingsOfTheWrongSizeOrNotFiniteAreIgnored) {
  StackSettings settings;
  settings.odometry_source = "wheeled";
  for (const bool is_mecanum : {false, true}) {
    const RobotDescription robot = make_robot_on_wheels(is_mecanum);
    for (const std::vector<double>& position_rad :
         {std::vector<double>{}, std::vector<double>{0.1, 0.2}, std::vector<double>(5, 0.1),
          std::vector<double>{0.1, 0.2, std::numeric_limits<double>::quiet_NaN(), 0.4},
          std::vector<double>{0.1, 0.2, 0.3, std::numeric_limits<double>::infinity()}}) {
      const auto odometry = make_odometry_source(settings, robot);
      stand(*odometry, position_rad);
      EXPECT_FALSE(odometry->estimate()) << is_mecanum;
    }
    const auto odometry = make_odometry_source(settings, robot);
    stand(*odometry, {0.1, 0.2, 0.3, 0.4});
    ASSERT_TRUE(odometry->estimate());
    EXPECT_LT(odometry->estimate()->T_odom_body.position.norm(), 0.01);
  }
}

// The robot stands on three wheels, and the fourth one turns in the air at 0.5 m/s.
TEST(OdometrySource, ALiftedWheelThatTurnsDoesNotMoveTheRobot) {
  StackSettings settings;
  settings.odometry_source = "wheeled";
  const auto odometry = make_odometry_source(settings, make_robot_on_wheels(false));
  std::vector<double> position_rad(4, 0.0);
  for (int tick = 0; tick < 6000; ++tick) {
    const double time_s = 0.004 * tick, dither = tick % 2 == 0 ? 1e-4 : -1e-4;
    odometry->add(Imu{.stamp = from_seconds(time_s),
                      .angular_velocity_radps = {0.0, 0.0, dither},
                      .linear_acceleration_mps2 = {dither, 0.0, 9.81}});
    if (time_s > 4.0) position_rad[0] += 0.004 * 0.5 / 0.1;
    if (tick % 5 == 0) odometry->add(joints_at(time_s, position_rad));
  }
  ASSERT_TRUE(odometry->estimate());
  EXPECT_LT(odometry->estimate()->T_odom_body.position.norm(), 0.1);
}

}  // namespace
}  // namespace patrol::stack::odometry_source_test
