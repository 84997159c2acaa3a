#include "core/wheel_kinematics.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "core/skid_spread.h"

namespace patrol {
namespace {

/// Wheel at (x, y), driven by joint `joint`.
WheelGeometry driven(double x_m, double y_m, std::size_t joint, double radius_m = 0.1) {
  return {.link = "w", .center_in_body = {x_m, y_m, 0.0}, .radius_m = radius_m, .drive_joint = joint};
}

RobotDescription four_wheels(double wheelbase_m, double gauge_m) {
  RobotDescription robot;
  robot.name = "four";
  std::size_t joint = 0;
  for (const double x : {0.5, -0.5}) {
    for (const double y : {0.5, -0.5}) {
      robot.wheels.push_back(driven(x * wheelbase_m, y * gauge_m, joint++));
      robot.joint_names.push_back("j" + std::to_string(joint));
      robot.joint_limits.push_back({.velocity_radps = 10.0, .effort_nm = 10.0});
    }
  }
  return robot;
}

/// Front wheels at `wheelbase` on steering joints, driven rear axle at the origin.
RobotDescription cart(double wheelbase_m, double gauge_m, double limit_rad) {
  RobotDescription robot;
  robot.name = "cart";
  robot.joint_names = {"rl", "rr", "fl_steer", "fr_steer"};
  robot.joint_limits.assign(
      4, {.lower_rad = -limit_rad, .upper_rad = limit_rad, .velocity_radps = 10.0, .effort_nm = 9.0});
  robot.wheels = {driven(0.0, 0.5 * gauge_m, 0), driven(0.0, -0.5 * gauge_m, 1)};
  for (const std::size_t side : {0, 1}) {
    WheelGeometry front{.link = "f", .center_in_body = {wheelbase_m, side == 0 ? 0.5 * gauge_m : -0.5 * gauge_m, 0.0}};
    front.radius_m = 0.1;
    front.steering_joint = 2 + side;
    robot.wheels.push_back(front);
  }
  return robot;
}

const std::vector<double> kStraight(4, 0.0);

TEST(SkidRatio, OfFourWheelsIsOnePlusTheSquareOfWheelbaseOverGauge) {
  for (const double wheelbase : {0.1, 0.3, 0.5, 1.0}) {
    EXPECT_NEAR(skid_ratio(four_wheels(wheelbase, 0.6)), 1.0 + std::pow(wheelbase / 0.6, 2), 1e-6) << wheelbase;
  }
}

// The published multipliers of the wheel separation of two skid-steer robots, found by tuning: 1.875 for a wheelbase of
// 0.512 m and a gauge of 0.5708 m, 1.5 for 0.262 m and 0.3765 m.
TEST(SkidRatio, IsWithin4PercentOfThePublishedRatiosOfTwoRealRobots) {
  EXPECT_NEAR(skid_ratio(four_wheels(0.512, 0.5708)), 1.875, 0.04 * 1.875);
  EXPECT_NEAR(skid_ratio(four_wheels(0.262, 0.3765)), 1.5, 0.04 * 1.5);
}

TEST(SkidRatio, OfSixWheelsIsBetweenThatOfTwoAndThatOfFour) {
  RobotDescription six = four_wheels(0.8, 0.6);
  six.wheels.push_back(driven(0.0, 0.3, 0));
  six.wheels.push_back(driven(0.0, -0.3, 1));
  EXPECT_GT(skid_ratio(six), 1.1);
  EXPECT_LT(skid_ratio(six), skid_ratio(four_wheels(0.8, 0.6)) - 0.1);
}

RobotDescription six_wheels(double wheelbase_m, double gauge_m) {
  RobotDescription six = four_wheels(wheelbase_m, gauge_m);
  six.wheels.push_back(driven(0.0, 0.5 * gauge_m, 0));
  six.wheels.push_back(driven(0.0, -0.5 * gauge_m, 1));
  return six;
}

/// Gauge ratio of six wheels with the loads of the outer axles and of the middle one: the moment of Coulomb friction
/// 2 No (B k / 2 - a^2) / sqrt(k^2 + a^2) + Nm B / 2 is zero, where a is half of the wheelbase.
double ratio_by_loads(double wheelbase_m, double gauge_m, double outer, double middle) {
  const double a = 0.5 * wheelbase_m;
  double low = 0.0, high = 2.0 * a * a / gauge_m;
  for (int i = 0; i < 60; ++i) {
    const double k = 0.5 * (low + high);
    const double moment = 2.0 * outer * (0.5 * gauge_m * k - a * a) / std::hypot(k, a) + 0.5 * middle * gauge_m;
    (moment > 0.0 ? high : low) = k;
  }
  return 1.0 + 2.0 * low / gauge_m;
}

// With the relative radii 1 + e and the deflection d, the mean load of the outer axles is 1 + 2 t and that of the
// middle one 1 - 4 t, where t = (mean of e over the outer wheels - mean over the middle ones) / (6 d), with the
// standard deviation sqrt(1/4 + 1/2) s / (6 d).
TEST(SkidRatio, VariesWithTheRadiiOfSixWheelsByTheLoadOfTheMiddleAxleAndNotWithThoseOfFour) {
  const RobotDescription six = six_wheels(1.2, 1.1);
  const double slope = (ratio_by_loads(1.2, 1.1, 1.002, 0.996) - ratio_by_loads(1.2, 1.1, 0.998, 1.004)) / 0.002;
  const double spread = skid_ratio_std(six, 0.001, 0.02);
  EXPECT_NEAR(spread, slope * std::sqrt(0.75) * 0.001 / (6.0 * 0.02), 1e-4);
  EXPECT_NEAR(spread, 0.0216, 0.001);
  EXPECT_NEAR(skid_ratio_std(six, 0.002, 0.02), 2.0 * spread, 1e-9);
  EXPECT_NEAR(skid_ratio_std(six, 0.002, 0.04), spread, 1e-9);
  EXPECT_EQ(skid_ratio_std(four_wheels(1.2, 1.1), 0.01, 0.02), 0.0);
}

TEST(SkidRatio, OfTwoWheelsIsOneWhereverTheAxleAndTheCasterAre) {
  RobotDescription two;
  two.wheels = {driven(0.2, 0.3, 0), driven(0.2, -0.3, 1)};
  WheelGeometry caster{.link = "c", .center_in_body = {-0.4, 0.0, 0.0}};
  caster.radius_m = 0.05;
  caster.is_caster = true;
  two.wheels.push_back(caster);
  EXPECT_DOUBLE_EQ(skid_ratio(two), 1.0);
  EXPECT_DOUBLE_EQ(differential_geometry(two).middle_x_m, 0.2);
  EXPECT_DOUBLE_EQ(differential_geometry(two).gauge_m, 0.6);
}

TEST(SkidTurn, WithTheCenterOfMassInTheMiddleIsThatOfEqualLoads) {
  RobotDescription robot = four_wheels(0.5, 0.6);
  for (WheelGeometry& wheel : robot.wheels) wheel.center_in_body.x() += 0.1;
  const SkidTurn equal = skid_turn(robot);
  EXPECT_NEAR(equal.turn_center_x_m, 0.1, 1e-15);
  robot.center_of_mass_x_m = 0.1;
  EXPECT_NEAR(skid_turn(robot).gauge_ratio, equal.gauge_ratio, 1e-9);
  EXPECT_NEAR(skid_turn(robot).turn_center_x_m, 0.1, 1e-9);
}

TEST(SkidTurn, WithTheCenterOfMassAboveAnAxleIsThatOfItsTwoWheels) {
  RobotDescription robot = four_wheels(0.5, 0.6);
  for (const double x : {0.25, -0.25}) {
    robot.center_of_mass_x_m = x;
    EXPECT_NEAR(skid_turn(robot).gauge_ratio, 1.0, 1e-6);
    EXPECT_NEAR(skid_turn(robot).turn_center_x_m, x, 1e-6);
  }
}

// Independent of the solver: friction of every wheel along its slip, at a yaw rate of 1 rad/s. If one axle can drive
// the turn with friction to spare, its wheels roll.
TEST(SkidTurn, HasNeitherALateralForceNorAMomentForFiftyDrawnRobotsUnlessOneAxleRolls) {
  int num_rolling = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomStream stream(seed, "skid_turn");
    const double wheelbase_m = 0.2 + 0.8 * stream.uniform(0), gauge_m = 0.3 + 0.7 * stream.uniform(1);
    RobotDescription robot = four_wheels(wheelbase_m, gauge_m);
    const double offset = 0.8 * (stream.uniform(2) - 0.5);  // of the wheelbase
    robot.center_of_mass_x_m = offset * wheelbase_m;
    const SkidTurn turn = skid_turn(robot);
    double lateral = 0.0, moment = 0.0;
    for (const WheelGeometry& wheel : robot.wheels) {
      const double load = 0.25 * (1.0 + (wheel.center_in_body.x() > 0.0 ? 2.0 : -2.0) * offset);
      const double y = wheel.center_in_body.y(), rim_mps = -turn.gauge_ratio * y;
      const Eigen::Vector2d slip(-y - rim_mps, wheel.center_in_body.x() - turn.turn_center_x_m);
      const Eigen::Vector2d force = -load * slip.normalized();
      lateral += force.y();
      moment += wheel.center_in_body.x() * force.y() - y * force.x();
    }
    const bool is_rolling = turn.gauge_ratio < 1.0 + 1e-6;
    num_rolling += is_rolling ? 1 : 0;
    EXPECT_NEAR(lateral, 0.0, 1e-6) << seed;
    if (is_rolling) {
      EXPECT_GT(moment, 0.0) << seed;
      EXPECT_NEAR(turn.turn_center_x_m, std::copysign(0.5 * wheelbase_m, offset), 1e-6) << seed;
    } else {
      EXPECT_NEAR(moment, 0.0, 1e-9) << seed;
    }
    EXPECT_LE(turn.gauge_ratio, 1.0 + std::pow(wheelbase_m / gauge_m, 2)) << "that of equal loads";
    EXPECT_GE(turn.turn_center_x_m * offset, 0.0) << "toward the center of mass";
  }
  EXPECT_GT(num_rolling, 5);
  EXPECT_LT(num_rolling, 40);
}

TEST(SkidRatio, OfTracksIsThatOfTwentyEvenlySpreadContacts) {
  RobotDescription robot;
  robot.tracks = TrackGeometry{.gauge_m = 0.55, .contact_length_m = 0.6, .sprocket_radius_m = 0.07};
  EXPECT_NEAR(skid_ratio(robot), 1.248, 1e-3);
}

TEST(WheelCommand, OfASkidSteerTurnHasOppositeSpeedsOfTheEffectiveGauge) {
  const RobotDescription robot = four_wheels(0.5, 0.6);
  const WheelCommand command = wheel_command(robot, 0.0, 0.5, 1.7, kStraight);
  EXPECT_NEAR(command.speed_radps[0], -0.5 * 1.7 * 0.3 / 0.1, 1e-12);
  EXPECT_NEAR(command.speed_radps[1], 0.5 * 1.7 * 0.3 / 0.1, 1e-12);
}

TEST(WheelCommand, AWheelWhoseAxisPointsToTheRightTurnsBackwardToDriveForward) {
  RobotDescription robot = four_wheels(0.5, 0.6);
  robot.wheels[1].forward_sign = -1.0;
  const WheelCommand command = wheel_command(robot, 0.4, 0.0, 1.7, kStraight);
  EXPECT_NEAR(command.speed_radps[0], 4.0, 1e-12);
  EXPECT_NEAR(command.speed_radps[1], -4.0, 1e-12);
}

// Ackermann: the axes of all wheels meet in one point, on the line of the rear axle.
TEST(WheelCommand, TheAxesOfSteeredWheelsMeetInTheTurnCenterOfTheCommand) {
  const double wheelbase = 1.1, gauge = 0.7;
  const RobotDescription robot = cart(wheelbase, gauge, 1.2);
  for (const double forward : {0.8, -0.8}) {
    for (const double radius : {1.0, 3.0, -2.0}) {
      const WheelCommand command = wheel_command(robot, forward, forward / radius, 1.0, kStraight);
      for (const std::size_t side : {0, 1}) {
        const double y = side == 0 ? 0.5 * gauge : -0.5 * gauge;
        EXPECT_NEAR(std::tan(command.angle_rad[2 + side]), wheelbase / (radius - y), 1e-9);
        EXPECT_NEAR(command.speed_radps[side], forward * (radius - y) / radius / 0.1, 1e-9);
      }
    }
  }
}

TEST(WheelCommand, ATighterTurnThanTheSteeringAllowsBecomesTheTightestOne) {
  const RobotDescription robot = cart(1.0, 0.6, to_rad(30.0));
  const double radius = 1.0 / std::tan(to_rad(30.0)) + 0.3;  // the inner wheel reaches its limit
  EXPECT_NEAR(min_turning_radius_m(robot), radius, 1e-9);
  for (const double rate : {5.0, -5.0}) {
    const WheelCommand command = wheel_command(robot, 0.5, rate, 1.0, kStraight);
    EXPECT_NEAR(std::max(std::abs(command.angle_rad[2]), std::abs(command.angle_rad[3])), to_rad(30.0), 1e-9);
    EXPECT_NEAR(0.1 * (command.speed_radps[1] - command.speed_radps[0]) / 0.6, std::copysign(0.5 / radius, rate), 1e-9);
  }
}

TEST(WheelCommand, StandingCartKeepsItsSteeringAndDoesNotTurn) {
  const RobotDescription robot = cart(1.0, 0.6, 0.5);
  const WheelCommand command = wheel_command(robot, 0.0, 1.0, 1.0, {0.0, 0.0, 0.3, 0.25});
  EXPECT_THAT(command.speed_radps, ::testing::Each(0.0));
  EXPECT_DOUBLE_EQ(command.angle_rad[2], 0.3);
  EXPECT_DOUBLE_EQ(command.angle_rad[3], 0.25);
}

TEST(WheelCommand, ASteeringJointAboutTheDownwardAxisHasTheOppositeAngleAndLimits) {
  RobotDescription robot = cart(1.0, 0.6, 0.5);
  robot.wheels[2].left_sign = robot.wheels[3].left_sign = -1.0;
  robot.joint_limits[2].lower_rad = robot.joint_limits[3].lower_rad = -0.2;  // to the left
  const WheelCommand command = wheel_command(robot, 0.5, 5.0, 1.0, kStraight);
  EXPECT_NEAR(std::min(command.angle_rad[2], command.angle_rad[3]), -0.2, 1e-9);
}

TEST(WheelDriveType, FollowsFromTheJointsAndNeedsMotorsOnBothSides) {
  EXPECT_EQ(wheel_drive_type(four_wheels(0.5, 0.6)), WheelDriveType::kDifferential);
  EXPECT_EQ(wheel_drive_type(cart(1.0, 0.6, 0.5)), WheelDriveType::kAckermann);
  RobotDescription one_sided = four_wheels(0.5, 0.6);
  one_sided.wheels[0].drive_joint.reset();
  one_sided.wheels[2].drive_joint.reset();
  EXPECT_THROW(wheel_drive_type(one_sided), InputError);
}

/// Four mecanum wheels of 0.1 m radius, 0.4 m long and 0.3 m wide, with an axis to either side.
RobotDescription mecanum(RollerPattern pattern = RollerPattern::kX, double angle_rad = M_PI / 4.0) {
  RobotDescription robot = four_wheels(0.4, 0.3);
  robot.wheels[1].forward_sign = -1.0;
  add_rollers(pattern, angle_rad, robot);
  return robot;
}

std::vector<double> forward_speeds(const RobotDescription& robot, const WheelCommand& command) {
  std::vector<double> speeds;
  for (const WheelGeometry& wheel : robot.wheels)
    speeds.push_back(wheel.forward_sign * command.speed_radps[*wheel.drive_joint]);
  return speeds;
}

// r w = vx -+ vy -+ (l + w) wz with half the wheelbase l = 0.2 m and half the gauge w = 0.15 m [Muir87]; order: front
// left, front right, rear left, rear right.
TEST(MecanumKinematics, WheelSpeedsOfTheThreeMotionsAreThoseOfTheClosedForm) {
  const RobotDescription robot = mecanum();
  using testing::DoubleNear, testing::ElementsAre;
  const auto speeds = [&](double vx, double vy, double wz) {
    return forward_speeds(robot, wheel_command(robot, vx, wz, 1.0, kStraight, vy));
  };
  EXPECT_THAT(speeds(0.5, 0.0, 0.0),
              ElementsAre(DoubleNear(5, 1e-9), DoubleNear(5, 1e-9), DoubleNear(5, 1e-9), DoubleNear(5, 1e-9)));
  EXPECT_THAT(speeds(0.0, 0.5, 0.0),
              ElementsAre(DoubleNear(-5, 1e-9), DoubleNear(5, 1e-9), DoubleNear(5, 1e-9), DoubleNear(-5, 1e-9)));
  EXPECT_THAT(speeds(0.0, 0.0, 1.0), ElementsAre(DoubleNear(-3.5, 1e-9), DoubleNear(3.5, 1e-9), DoubleNear(-3.5, 1e-9),
                                                 DoubleNear(3.5, 1e-9)));
}

TEST(MecanumKinematics, ARollerAngleOf30DegreesToTheAxleRaisesTheWheelSpeedOfALateralMotionByTheRootOf3) {
  const RobotDescription robot = mecanum(RollerPattern::kX, M_PI / 6.0);
  EXPECT_NEAR(forward_speeds(robot, wheel_command(robot, 0.0, 0.0, 1.0, kStraight, 0.5))[1], 5.0 * std::sqrt(3.0),
              1e-9);
}

TEST(MecanumKinematics, ThePatternOReversesTheWheelsInALateralMotionAndItsLeverIsTheDifference) {
  const RobotDescription robot = mecanum(RollerPattern::kO);
  EXPECT_NEAR(forward_speeds(robot, wheel_command(robot, 0.0, 0.0, 1.0, kStraight, 0.5))[0], 5.0, 1e-9);
  EXPECT_NEAR(forward_speeds(robot, wheel_command(robot, 0.0, 1.0, 1.0, kStraight))[0], 0.5, 1e-9);
}

TEST(MecanumKinematics, ForwardKinematicsInvertTheWheelSpeedsTo1e9WithoutResidual) {
  for (const RollerPattern pattern : {RollerPattern::kX, RollerPattern::kO}) {
    const RobotDescription robot = mecanum(pattern, 0.7);
    const WheelMotion motion = mecanum_motion(robot, wheel_command(robot, 0.3, -0.7, 1.0, kStraight, 0.2).speed_radps);
    EXPECT_LT((motion.velocity - Eigen::Vector3d(0.3, 0.2, -0.7)).norm(), 1e-9);
    EXPECT_NEAR(motion.residual_mps, 0.0, 1e-9);
  }
}

// Front and rear wheels against each other: the only speeds that no motion explains.
TEST(MecanumKinematics, AWheelThatSpins1MeterPerSecondFasterLeavesAResidualOf0_25AndIsAQuarterOfTheSpeed) {
  const RobotDescription robot = mecanum();
  std::vector<double> speeds = wheel_command(robot, 0.3, 0.0, 1.0, kStraight).speed_radps;
  speeds[2] += 10.0;
  const WheelMotion motion = mecanum_motion(robot, speeds);
  EXPECT_NEAR(motion.velocity.x(), 0.3 + 0.25, 1e-9);
  EXPECT_NEAR(motion.residual_mps, -0.25, 1e-9);
}

TEST(MecanumKinematics, AtTheLimitOf10RadiansPerSecondAllWheelsAreScaledSoThatTheDirectionStays) {
  const RobotDescription robot = mecanum();
  std::vector<double> speeds = wheel_command(robot, 1.0, 0.0, 1.0, kStraight, 0.5).speed_radps;
  limit_wheel_speeds(robot, speeds);
  const WheelMotion motion = mecanum_motion(robot, speeds);
  EXPECT_NEAR(motion.velocity.x(), 1.0 / 1.5, 1e-9);
  EXPECT_NEAR(motion.velocity.y(), 0.5 / 1.5, 1e-9);
}

TEST(MecanumKinematics, TheGaugeRatioIsOnePlusWheelbaseOverGaugeAndTheRobotTurnsInPlaceAboutItsOrigin) {
  const RobotDescription robot = mecanum();
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kMecanum);
  EXPECT_NEAR(skid_ratio(robot), 1.0 + 0.4 / 0.3, 1e-9);
  EXPECT_EQ(min_turning_radius_m(robot), 0.0);
  EXPECT_EQ(differential_geometry(robot).middle_x_m, 0.0);
}

TEST(MecanumKinematics, RefusesOtherWheelsThanFourDrivenOnesThatAreNotSteeredAndRollersWithoutLever) {
  const auto error_of = [](RobotDescription robot, RollerPattern pattern) -> std::string {
    try {
      add_rollers(pattern, M_PI / 4.0, robot);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  using testing::HasSubstr;
  RobotDescription three = four_wheels(0.4, 0.3), passive = four_wheels(0.4, 0.3), one_sided = four_wheels(0.4, 0.3);
  three.wheels.pop_back();
  passive.wheels[2].drive_joint.reset();
  one_sided.wheels[0].center_in_body.x() = -0.3;
  EXPECT_THAT(error_of(three, RollerPattern::kX), HasSubstr("3 wheels: must be four"));
  EXPECT_THAT(error_of(passive, RollerPattern::kX), HasSubstr("has no motor: all four must be driven"));
  EXPECT_THAT(error_of(one_sided, RollerPattern::kX), HasSubstr("each side must have a front and a rear wheel"));
  EXPECT_THAT(error_of(cart(1.0, 0.6, 0.5), RollerPattern::kX), HasSubstr("is steered: must not be steered"));
  EXPECT_THAT(error_of(four_wheels(0.4, 0.4), RollerPattern::kO), HasSubstr("do not turn it"));
  EXPECT_EQ(error_of(four_wheels(0.4, 0.4), RollerPattern::kX), "");
}

}  // namespace
}  // namespace patrol
