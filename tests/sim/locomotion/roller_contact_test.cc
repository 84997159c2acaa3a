// Mecanum wheels on MuJoCo's contacts against closed forms.

#include "sim/locomotion/roller_contact.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/gravity.h"
#include "core/wheel_kinematics.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_wheeled_robot.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim::roller_contact_test {
namespace {

WheelDriveSettings mecanum(double friction = 0.8) {
  WheelDriveSettings settings;
  settings.type = "mecanum";
  settings.friction = friction;
  return settings;
}

/// Robot of 44 kg, wheelbase 0.5 m, gauge 0.6 m.
WheeledRobot make_robot(const WheelDriveSettings& settings = mecanum()) {
  return WheeledRobot(make_flat_world(), test::skid_steer_urdf(0.5, 0.6).text(), settings);
}

/// Tilts gravity instead of the ground: a slope that falls toward a direction in the start frame of the robot.
void set_slope(WheeledRobot& robot, double angle_deg, double direction_deg) {
  const double down = kGravity_mps2 * std::sin(to_rad(angle_deg));
  robot.options().gravity[0] = down * std::cos(to_rad(direction_deg));
  robot.options().gravity[1] = down * std::sin(to_rad(direction_deg));
  robot.options().gravity[2] = -kGravity_mps2 * std::cos(to_rad(angle_deg));
}

TEST(Mecanum, ForwardLateralAndDiagonalMotionsCoverTheCommandedDistanceTo2PercentWithoutYaw) {
  for (const auto& [vx, vy] : {std::pair(0.4, 0.0), std::pair(0.0, 0.4), std::pair(0.0, -0.4), std::pair(0.3, 0.3),
                               std::pair(0.3, -0.3), std::pair(-0.4, 0.2)}) {
    WheeledRobot robot = make_robot();
    robot.drive(vx, 0.0, 1.0, vy);
    const WheelReport report = robot.drive(vx, 0.0, 10.0, vy);
    const double length = 10.0 * std::hypot(vx, vy);
    EXPECT_NEAR(report.moved.x, 10.0 * vx, 0.02 * length) << vx << ", " << vy;
    EXPECT_NEAR(report.moved.y, 10.0 * vy, 0.02 * length) << vx << ", " << vy;
    EXPECT_NEAR(report.moved.yaw, 0.0, 0.01) << vx << ", " << vy;
  }
}

TEST(Mecanum, ATurnInPlaceIsTheCommandedOneTo1PercentAndTheCenterStaysWithin1Centimeter) {
  WheeledRobot robot = make_robot();
  robot.drive(0.0, 0.5, 1.0);
  const WheelReport turn = robot.drive(0.0, 0.5, 2.0 * M_PI / 0.5);
  EXPECT_NEAR(turn.moved.yaw, 2.0 * M_PI, 0.01 * 2.0 * M_PI);
  EXPECT_LT(turn.moved.position().norm(), 0.01);
}

// A constant lateral velocity and yaw rate in body: a circle of the radius v / w.
TEST(Mecanum, ALateralMotionWithAYawRateDrivesACircleOf1MeterTo2Percent) {
  WheeledRobot robot = make_robot();
  robot.drive(0.0, 0.3, 2.0, 0.3);
  const WheelReport half = robot.drive(0.0, 0.3, M_PI / 0.3, 0.3);
  EXPECT_NEAR(half.moved.yaw, M_PI, 0.02 * M_PI);
  EXPECT_NEAR(half.moved.position().norm(), 2.0, 0.04);
}

TEST(Mecanum, RollersOf30DegreesToTheAxleMoveTheRobotLaterallyAsCommandedTo2Percent) {
  WheelDriveSettings settings = mecanum();
  settings.roller_angle_rad = M_PI / 6.0;
  WheeledRobot robot = make_robot(settings);
  robot.drive(0.0, 0.0, 1.0, 0.3);
  EXPECT_NEAR(robot.drive(0.0, 0.0, 10.0, 0.3).moved.y, 3.0, 0.06);
}

// Locked wheels: along each direction u the four rollers resist with mu N |a_i u| in their axes a_i of +-45 degrees to
// x. The friction of each wheel is at most mu N along its axis, so that a force along x or y slides at 1 / sqrt(2) of
// the force of isotropic friction, and one along the axis of two wheels slides when these two slide.
TEST(Mecanum, LockedWheelsStopFrom1MeterPerSecondForwardAndLaterallyWithin3PercentOfTheClosedForm) {
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0)}) {
    for (const double friction : {0.3, 0.8}) {
      WheelDriveSettings settings = mecanum(friction);
      settings.roller_friction = 0.001;
      WheeledRobot robot = make_robot(settings);
      robot.open_brakes();
      robot.push(direction, {0.0, 0.0, 0.0, 0.0});
      robot.lock_wheels();
      const Eigen::Vector3d start = robot.T_world_body().position;
      robot.roll(3.0);
      const double expected_m = 1.0 / (2.0 * friction / std::sqrt(2.0) * kGravity_mps2);
      const double stop_m = (robot.T_world_body().position - start).head<2>().dot(direction);
      EXPECT_NEAR(stop_m, expected_m, 0.03 * expected_m + 0.002) << direction.transpose() << ", " << friction;
    }
  }
}

// Along x and y all four wheels resist, and the angle of friction is arctan(mu / sqrt(2)): 15.8 degrees for 0.4
// and 29.5 degrees for 0.8. Along a diagonal only two wheels resist, on half of the weight: arctan(mu / 2), 11.3
// and 21.8 degrees.
TEST(Mecanum, WithClosedBrakesItStands2DegreesBelowTheAngleOfFrictionInEightDirectionsAndSlides4DegreesAbove) {
  for (const double friction : {0.4, 0.8}) {
    WheelDriveSettings settings = mecanum(friction);
    settings.brake_torque_ratio = 10.0;
    settings.roller_friction = 0.001;
    for (double direction_deg = 0.0; direction_deg < 360.0; direction_deg += 45.0) {
      const bool is_diagonal = std::abs(std::remainder(direction_deg, 90.0)) > 1.0;
      const double effective = friction * (is_diagonal ? 0.5 : std::sqrt(0.5));
      const double limit_deg = to_deg(std::atan(effective));
      WheeledRobot below = make_robot(settings);
      set_slope(below, limit_deg - 2.0, direction_deg);
      below.drive(0.0, 0.0, 2.0);
      EXPECT_LT(below.drive(0.0, 0.0, 5.0).moved.position().norm(), 0.01) << friction << ", " << direction_deg;
      WheeledRobot above = make_robot(settings);
      set_slope(above, limit_deg + 4.0, direction_deg);
      above.drive(0.0, 0.0, 1.0);
      const double v0 = above.velocity_mps().norm();
      EXPECT_GT(v0, 0.2) << friction << ", " << direction_deg;
      // Along a diagonal the sliding wheels rise, as MuJoCo's sliding contacts do, and take load from the others.
      if (is_diagonal) continue;
      above.drive(0.0, 0.0, 1.0);
      const double angle_rad = to_rad(limit_deg + 4.0);
      const double a = kGravity_mps2 * (std::sin(angle_rad) - effective * std::cos(angle_rad));
      EXPECT_NEAR(above.velocity_mps().norm() - v0, a, 0.05 * a) << friction << ", " << direction_deg;
    }
  }
}

// Without slip along the axes, the rims turn at vx +- vy and all rollers at sqrt(2) vy, whatever vx is. The rollers'
// friction c and the rolling resistance d of the wheels decelerate a lateral motion of the mass m, of which the wheels
// have the inertia J each, with (sqrt(2) c + d) m g / (m + 4 J / r^2).
double lateral_deceleration_mps2(const WheelDriveSettings& settings, double mass_kg) {
  const double carried_kg = mass_kg + settings.rotor_inertia_ratio * mass_kg + 4.0 * 0.5;
  return (std::sqrt(2.0) * settings.roller_friction + settings.rolling_resistance) * mass_kg * kGravity_mps2 /
         carried_kg;
}

void push_without_slip(WheeledRobot& robot, const Eigen::Vector2d& v_mps) {
  robot.open_brakes();
  std::vector<double> wheel_radps;
  for (const WheelGeometry& wheel : robot.description().wheels)
    wheel_radps.push_back((v_mps.x() + std::tan(*wheel.roller_axis_rad) * v_mps.y()) / wheel.radius_m);
  robot.push(v_mps, wheel_radps);
}

TEST(Mecanum, PushedLaterallyWithoutMotorsItRollsAndDeceleratesByTheClosedFormTo2Percent) {
  WheeledRobot robot = make_robot();
  push_without_slip(robot, {0.0, 0.5});
  const double start_y = robot.T_world_body().position.y();
  robot.roll(1.0);
  const double a = lateral_deceleration_mps2(mecanum(), robot.description().mass_kg);
  EXPECT_NEAR(robot.velocity_mps().y(), 0.5 - a, 0.02 * a);
  EXPECT_NEAR(robot.T_world_body().position.y() - start_y, 0.5 - 0.5 * a, 0.005);
}

TEST(Mecanum, PushedDiagonallyWithoutMotorsTheRollersDecelerateTheLateralSpeedOnlyTo2Percent) {
  WheelDriveSettings settings = mecanum();
  settings.rolling_resistance = 0.0;
  WheeledRobot robot = make_robot(settings);
  push_without_slip(robot, {0.5, 0.5});
  robot.roll(1.0);
  const double a = lateral_deceleration_mps2(settings, robot.description().mass_kg);
  EXPECT_NEAR(robot.velocity_mps().x(), 0.5, 0.002);
  EXPECT_NEAR(robot.velocity_mps().y(), 0.5 - a, 0.02 * a);
}

TEST(Mecanum, OnASlopeOf10DegreesItCreepsByLessThan1MillimeterPerSecondWithItsBrakesClosedInEightDirections) {
  for (double direction_deg = 0.0; direction_deg < 360.0; direction_deg += 45.0) {
    WheeledRobot robot = make_robot();
    set_slope(robot, 10.0, direction_deg);
    robot.drive(0.0, 0.0, 2.0);
    EXPECT_LT(robot.drive(0.0, 0.0, 5.0).moved.position().norm(), 0.005) << direction_deg;
  }
}

TEST(Mecanum, TwoRunsOfOneProgramEndInTheSameBytes) {
  const auto end_of = [] {
    WheeledRobot robot = make_robot();
    robot.drive(0.2, 0.3, 3.0, 0.3);
    return robot.T_world_body().position;
  };
  EXPECT_EQ(end_of(), end_of());
}

TEST(Mecanum, WithoutRollersTheSameWheelsDoNotMoveLaterally) {
  WheelDriveSettings settings = mecanum();
  settings.type = "auto";
  WheeledRobot robot = make_robot(settings);
  EXPECT_LT(robot.drive(0.0, 0.0, 3.0, 0.4).moved.position().norm(), 1e-3);
}

TEST(Mecanum, ARobotWithCastersIsRefusedWithTheNameOfTheSetting) {
  try {
    WheeledRobot(make_flat_world(), test::differential_urdf().text(), mecanum());
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("wheel_drive.type = mecanum: robot synthetic: mecanum wheels: 3 wheels"));
  }
}

}  // namespace
}  // namespace patrol::sim::roller_contact_test
