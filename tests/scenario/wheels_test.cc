// Wheeled robots on MuJoCo's contacts against closed forms.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/wheel_kinematics.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_wheeled_robot.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::sim::wheels_test {
namespace {

using test::ackermann_urdf, test::differential_urdf, test::skid_steer_urdf;

constexpr double kGravity_mps2 = 9.81;

/// Kinematics with the geometric gauge: the wheels turn as commanded.
WheelDriveSettings with_geometric_gauge(double friction = 0.8) {
  WheelDriveSettings settings;
  settings.effective_gauge_factor = 1.0;
  settings.friction = friction;
  return settings;
}

/// Tilts gravity instead of the ground: a slope up ahead of the robot.
void set_slope(WheeledRobot& robot, double angle_deg) {
  robot.options().gravity[0] = -kGravity_mps2 * std::sin(to_rad(angle_deg));
  robot.options().gravity[2] = -kGravity_mps2 * std::cos(to_rad(angle_deg));
}

/// Returns the ratio of the yaw of the wheel travels and the geometric gauge to the true yaw, in a steady turn.
double measured_skid_ratio(WheeledRobot& robot, double forward_mps, double yaw_rate_radps) {
  robot.drive(forward_mps, yaw_rate_radps, 2.0);
  const WheelReport turn = robot.drive(forward_mps, yaw_rate_radps, 6.0);
  return (turn.right_m - turn.left_m) / differential_geometry(robot.description()).gauge_m / turn.moved.yaw;
}

TEST(Wheels, TenMetersStraightEndWithin5MillimetersOfTheTravelOfTheWheelsAndWithin1CentimeterOfTheLine) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text());
  robot.drive(0.8, 0.0, 1.0);
  const WheelReport report = robot.drive(0.8, 0.0, 12.5);
  EXPECT_NEAR(report.moved.x, 0.5 * (report.left_m + report.right_m), 0.005);
  EXPECT_NEAR(report.moved.y, 0.0, 0.01);
  EXPECT_GT(report.moved.x, 9.0);
}

// Rolling resistance c and bearing friction T of n wheels of radius r stop a robot of mass m, whose n motors and wheels
// have the inertia J, with a = (c m g + n T / r) / (m + n J / r^2).
TEST(Wheels, FreeRollingEndsWithin1PercentOfTheDistanceOfRollingResistanceAndBearingFriction) {
  test::UrdfRobot description = skid_steer_urdf(0.5, 0.6);
  description.bearing_friction_nm = 0.2;
  WheelDriveSettings settings;
  settings.rolling_resistance = 0.02;
  WheeledRobot robot(make_flat_world(), description.text(), settings);
  const double mass_kg = robot.description().mass_kg, r = 0.15, v = 1.2;
  const double inertia_kgm2 = 0.5 * r * r + settings.rotor_inertia_ratio * mass_kg / 4.0 * r * r;
  const double a = (0.02 * mass_kg * kGravity_mps2 + 4.0 * 0.2 / r) / (mass_kg + 4.0 * inertia_kgm2 / (r * r));
  robot.push(v);
  const double start_x = robot.T_world_body().position.x();
  robot.roll(v / a + 1.0);
  EXPECT_NEAR(robot.speed_mps(), 0.0, 1e-3);
  EXPECT_NEAR(robot.T_world_body().position.x() - start_x, v * v / (2.0 * a), 0.01 * v * v / (2.0 * a));
}

TEST(Wheels, LockedWheelsStopFrom1And2MetersPerSecondWithin2PercentOfTheFrictionLimit) {
  for (const double friction : {0.3, 0.8}) {
    for (const double v : {1.0, 2.0}) {
      WheelDriveSettings settings;
      settings.friction = friction;
      WheeledRobot robot(make_flat_world(), wheeled_urdf_text(), settings);
      robot.push(v);
      robot.lock_wheels();
      const double start_x = robot.T_world_body().position.x();
      robot.roll(2.0);
      const double expected_m = v * v / (2.0 * friction * kGravity_mps2);
      EXPECT_NEAR(robot.T_world_body().position.x() - start_x, expected_m, 0.02 * expected_m + 0.002)
          << friction << ", " << v;
    }
  }
}

// 1 + (0.512 / 0.5708)^2 = 1.805; the manufacturer publishes 1.875 for the real robot.
TEST(Wheels, TurningInPlaceIsWithin2PercentOfTheClosedFormOfCoulombFrictionAtThreeRatesAndTwoFrictions) {
  for (const double friction : {0.4, 0.8}) {
    for (const double rate : {0.2, 0.5, 1.0}) {
      WheeledRobot robot(make_flat_world(), wheeled_urdf_text(), with_geometric_gauge(friction));
      const double expected = skid_ratio(robot.description());
      EXPECT_NEAR(measured_skid_ratio(robot, 0.0, rate), expected, 0.02 * expected) << friction << ", " << rate;
    }
  }
}

TEST(Wheels,
     WithTheCenterOfMassAFifthOfTheWheelbaseBehindTheMiddleTheTurnIsThatOfTheClosedFormTo3PercentAnd1Centimeter) {
  test::UrdfRobot description = skid_steer_urdf(0.5, 0.6);
  description.center_of_mass_x_m = -0.11;
  for (const double rate : {0.3, 0.8}) {
    WheeledRobot robot(make_flat_world(), description.text(), with_geometric_gauge());
    const SkidTurn expected = skid_turn(robot.description());
    EXPECT_NEAR(*robot.description().center_of_mass_x_m, -0.1, 1e-9) << "the wheels have a tenth of the mass";
    EXPECT_LT(expected.gauge_ratio, 1.35) << "1.69 with equal loads";
    EXPECT_LT(expected.turn_center_x_m, -0.15);
    EXPECT_NEAR(measured_skid_ratio(robot, 0.0, rate), expected.gauge_ratio, 0.03 * expected.gauge_ratio) << rate;
    const Pose2 T_world_begin = to_pose2(robot.T_world_body());
    robot.drive(0.0, rate, 0.5 * M_PI * expected.gauge_ratio / rate);
    const Eigen::Vector2d center(expected.turn_center_x_m, 0.0);
    const Eigen::Vector2d moved_m = to_pose2(robot.T_world_body()) * center - T_world_begin * center;
    EXPECT_LT(moved_m.norm(), 0.01) << rate;
  }
}

TEST(Wheels, InACurveOf2MetersTheRatioIsThatOfATurnInPlaceTo3Percent) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text(), with_geometric_gauge());
  const double expected = skid_ratio(robot.description());
  EXPECT_NEAR(measured_skid_ratio(robot, 0.6, 0.3), expected, 0.03 * expected);
}

TEST(Wheels, WithTheClosedFormInTheFirmwareTheYawRateIsTheCommandedOneTo2Percent) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text());
  robot.drive(0.0, 0.5, 2.0);
  EXPECT_NEAR(robot.drive(0.0, 0.5, 6.0).moved.yaw, 3.0, 0.06);
}

TEST(Wheels, SixWheelsTurnByTheClosedFormTo3Percent) {
  test::UrdfRobot description = skid_steer_urdf(0.8, 0.6);
  description.wheels.push_back({.name = "middle_left", .x_m = 0.0, .y_m = 0.3});
  description.wheels.push_back({.name = "middle_right", .x_m = 0.0, .y_m = -0.3});
  WheeledRobot robot(make_flat_world(), description.text(), with_geometric_gauge());
  const double expected = skid_ratio(robot.description());
  EXPECT_NEAR(measured_skid_ratio(robot, 0.0, 0.4), expected, 0.03 * expected);
}

TEST(Wheels, ADifferentialDriveTurnsAboutItsAxleByItsGaugeTo1PercentWithAnAxisToEitherSide) {
  WheeledRobot robot(make_flat_world(), differential_urdf().text());
  const WheelReport turn = robot.drive(0.0, 0.5, 2.0 * M_PI / 0.5);
  EXPECT_NEAR((turn.right_m - turn.left_m) / 0.5, turn.moved.yaw, 0.01 * turn.moved.yaw);
  const Eigen::Vector2d axle =
      robot.description().wheels[0].center_in_body.head<2>().cwiseProduct(Eigen::Vector2d(1, 0));
  const Eigen::Vector2d axle_moved = turn.moved * axle - axle;
  EXPECT_LT(axle_moved.norm(), 0.01);
}

TEST(Wheels, AnAckermannCartDrivesTheCircleOfItsMinimumTurningRadiusTo2Percent) {
  for (const double side : {1.0, -1.0}) {
    WheeledRobot robot(make_flat_world(), ackermann_urdf(1.0, 0.6, 0.5).text());
    const double radius_m = min_turning_radius_m(robot.description());
    EXPECT_NEAR(radius_m, 1.0 / std::tan(0.5) + 0.3, 1e-6);
    robot.drive(0.5, side, 3.0);
    const WheelReport turn = robot.drive(0.5, side, 6.0);
    const double measured_m = 0.5 * (turn.left_m + turn.right_m) / std::abs(turn.moved.yaw);
    EXPECT_NEAR(measured_m, radius_m, 0.02 * radius_m);
    EXPECT_GT(side * turn.moved.yaw, 0.0);
  }
}

TEST(Wheels, AnAckermannCartIsNotTurnedByACommandToTurnInPlace) {
  WheeledRobot robot(make_flat_world(), ackermann_urdf(1.0, 0.6, 0.5).text());
  const WheelReport turn = robot.drive(0.0, 1.0, 5.0);
  EXPECT_NEAR(turn.moved.yaw, 0.0, 1e-3);
}

// The friction angles are 21.8 degrees for 0.4 and 38.7 degrees for 0.8.
TEST(Wheels, WithClosedBrakesItStands2DegreesBelowTheAngleOfFrictionAndSlides6DegreesAboveAsTheClosedForm) {
  for (const double friction : {0.4, 0.8}) {
    const double angle_deg = to_deg(std::atan(friction));
    WheelDriveSettings settings;
    settings.friction = friction;
    settings.brake_torque_ratio = 4.0;
    WheeledRobot below(make_flat_world(), wheeled_urdf_text(), settings);
    set_slope(below, angle_deg - 2.0);
    below.drive(0.0, 0.0, 2.0);
    const double creep_m = std::abs(below.drive(0.0, 0.0, 5.0).moved.x);
    EXPECT_LT(creep_m, 0.02) << friction;
    WheeledRobot above(make_flat_world(), wheeled_urdf_text(), settings);
    set_slope(above, angle_deg + 6.0);
    above.drive(0.0, 0.0, 2.0);
    const double v0 = above.speed_mps();
    above.drive(0.0, 0.0, 1.0);
    const double a = kGravity_mps2 * (std::sin(to_rad(angle_deg + 6.0)) - friction * std::cos(to_rad(angle_deg + 6.0)));
    EXPECT_NEAR(v0 - above.speed_mps(), a, 0.05 * a) << friction;
  }
}

TEST(Wheels, OnASlopeOf15DegreesItCreepsByLessThan1MillimeterPerSecondWithItsBrakesClosed) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text());
  set_slope(robot, 15.0);
  robot.drive(0.0, 0.0, 2.0);
  EXPECT_LT(robot.drive(0.0, 0.0, 5.0).moved.position().norm(), 0.005);
}

TEST(Wheels, ItClimbs20DegreesAtTheCommandedSpeedWithTheTorqueOfItsWeight) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text());
  set_slope(robot, 20.0);
  robot.drive(0.4, 0.0, 3.0);
  const WheelReport climb = robot.drive(0.4, 0.0, 5.0);
  EXPECT_NEAR(0.5 * (climb.left_m + climb.right_m), 2.0, 0.02);
  // 50 kg x 9.81 m/s2 x sin(20 degrees) x 0.1651 m / 4 wheels, rolling resistance 0.30 N m, bearing 0.6 N m.
  EXPECT_NEAR(climb.mean_torque_nm, 6.92 + 0.30 + 0.6, 0.1);
}

TEST(Wheels, LiftedOffTheGroundTheWheelsReachTheCommandedSpeedWithoutOscillation) {
  WheeledRobot robot(make_flat_world(R"(<geom name="ground_block" type="box" size="0.3 0.15 0.11" pos="0 0 0.11"/>)"),
                     wheeled_urdf_text());
  robot.drive(0.5, 0.0, 3.0);
  const WheelReport spin = robot.drive(0.5, 0.0, 2.0);
  EXPECT_NEAR(0.5 * (spin.left_m + spin.right_m), 1.0, 0.01);
  EXPECT_LT(spin.max_abs_torque_nm, 3.0);
}

// The controllers of the wheels wind up by 0.3 rad until the friction slides.
TEST(Wheels, LeftWheelsOf101PercentTurnTheRobotByTheDifferenceOverTheEffectiveGaugeTo5Percent) {
  WheeledRobot robot(make_flat_world(), wheeled_urdf_text(), {}, {.radius_scale = {1.01, 1.0, 1.01, 1.0}});
  robot.drive(0.8, 0.0, 20.0);
  const WheelReport report = robot.drive(0.8, 0.0, 10.0);
  const double expected_rad = -0.01 * report.left_m / (0.5708 * skid_ratio(robot.description()));
  EXPECT_NEAR(report.moved.yaw, expected_rad, -0.05 * expected_rad);
}

}  // namespace
}  // namespace patrol::sim::wheels_test
