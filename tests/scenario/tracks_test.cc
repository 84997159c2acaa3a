// The tracked robot on MuJoCo's contacts against closed forms of what tracks do.

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/sim/rubble.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"

namespace patrol::sim::tracks_test {
namespace {

constexpr double kWeight_n = 85.0 * 9.81;
constexpr double kPitchRadius_m = 0.070;
constexpr double kGauge_m = 0.55;
constexpr double kGearFriction_nm = 1.5;

/// Without the gyroscope, and counting with the tracks' own gauge: the belts do as they are told.
TrackDriveSettings open_loop(double friction = 0.8) {
  TrackDriveSettings settings;
  settings.use_gyro = false;
  settings.effective_gauge_factor = 1.0;
  settings.friction = friction;
  return settings;
}

std::string make_slope(double angle_deg) {
  return make_world(fmt::format(R"(<geom name="ground" type="plane" size="50 50 1" euler="0 {} 0"/>)", -angle_deg));
}

/// 15 degrees up over 3 m, 2 m level, and down again; it begins 1.5 m ahead.
std::string make_ramp() {
  const double a = to_rad(15.0), run = 3.0 * std::cos(a), rise = 3.0 * std::sin(a), t = 0.1;
  const double x_up = 1.5 + run / 2.0 + t * std::sin(a), x_down = 1.5 + run + 2.0 + run / 2.0 - t * std::sin(a);
  const double z = rise / 2.0 - t * std::cos(a);
  return make_flat_world(
      fmt::format(R"(<geom name="ground_up" type="box" size="1.5 1 0.1" pos="{} 0 {}" euler="0 -15 0"/>
    <geom name="ground_top" type="box" size="1 1 0.1" pos="{} 0 {}"/>
    <geom name="ground_down" type="box" size="1.5 1 0.1" pos="{} 0 {}" euler="0 15 0"/>)",
                  x_up, z, 1.5 + run + 1.0, rise - t, x_down, z));
}

/// A wall as slippery as wet ice 1 m before the robot's front.
std::string make_wall() {
  return make_flat_world(
      R"(<geom name="wall" type="box" size="0.1 1 0.5" pos="1.6 0 0.5" priority="2" friction="0.01"/>)");
}

double turned_over_kinematic(const DriveReport& turn) {
  return turn.moved.yaw / ((turn.right_belt_m - turn.left_belt_m) / kGauge_m);
}

/// Turning on the spot with evenly loaded road wheels at x_i and Coulomb friction. With the belts at -+u and the robot
/// at yaw rate w, wheel i of the right track slides over the ground at (s, w x_i), s = w B/2 - u, so the ground pushes
/// it with mu N along
/// -(s, w x_i). No moment is left over in a steady turn:
///   sum_i (B/2 k - x_i^2) / sqrt(k^2 + x_i^2) = 0,   k = -s / w,
/// which gives k whatever mu and w are: the centres of rotation of the tracks lie B/2 + k beside the robot's middle, as
/// Martinez et al. (IJRR 2005) find for real tracks, and the robot turns by (B/2) / (B/2 + k) of what the belts and the
/// gauge say.
struct ScrubTurn {
  double ratio;           ///< true over kinematic yaw
  double sum_of_cosines;  ///< sum of the cosines of the angles between each wheel's friction and x
};
ScrubTurn closed_form() {
  const std::vector<double> wheels_m = {-0.30, -0.15, 0.0, 0.15, 0.30};
  const double half = kGauge_m / 2.0;
  double low = 1e-9, high = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double k = (low + high) / 2.0;
    double moment = 0.0;
    for (const double x : wheels_m) moment += (half * k - x * x) / std::hypot(k, x);
    (moment > 0.0 ? high : low) = k;
  }
  double sum = 0.0;
  for (const double x : wheels_m) sum += low / std::hypot(low, x);
  return {.ratio = half / (half + low), .sum_of_cosines = sum};
}

/// One steady turn all the way round, so that the cone's direction in the world does not count.
DriveReport turn_around(TrackedRobot& robot, double yaw_rate_radps) {
  robot.drive(0.0, yaw_rate_radps, 2.0);
  return robot.drive(0.0, yaw_rate_radps, 2.0 * M_PI / (0.71 * yaw_rate_radps));
}

TEST(Tracks, TheClosedFormOfFiveEvenlyLoadedWheelsIsARatioOf0_708) { EXPECT_NEAR(closed_form().ratio, 0.708, 5e-4); }

/// Robot whose contacts have round friction cones. The twin's pyramidal cones resist a sliding contact along one axis
/// at a time: belts that slide along x leave the body free to creep along y.
void use_round_cones(TrackedRobot& robot) { robot.options().cone = mjCONE_ELLIPTIC; }

/// Largest creep along y that pyramidal cones may cause, relative to the distance over which the belts slide. On dry
/// ground (friction 0.8): twice the measured 0.80 %. On ice (friction 0.05), where 0.14 % are measured: 6 mm over 2.5
/// m.
constexpr double kMaxCreepOnDryGround = 0.016, kMaxCreepOnIce = 0.0024;

// Robot and belts are symmetric about x, so the closed form of y and yaw is zero.
TEST(Tracks, UnderRoundConesTenMetresStraightEndWithin1CentimetreOfTheLine) {
  TrackedRobot robot(make_flat_world(), {}, open_loop());
  use_round_cones(robot);
  robot.drive(0.5, 0.0, 1.0);
  const DriveReport report = robot.drive(0.5, 0.0, 20.0);
  EXPECT_NEAR(report.moved.x, 10.0, 0.05);
  EXPECT_NEAR(report.moved.y, 0.0, 0.01);
}

TEST(Tracks, TenMetresStraightSlipByLessThanHalfAPercent) {
  TrackedRobot robot(make_flat_world(), {}, open_loop());
  robot.drive(0.5, 0.0, 1.0);
  const DriveReport report = robot.drive(0.5, 0.0, 20.0);
  const double slip = 1.0 - report.moved.x / report.left_belt_m;
  EXPECT_NEAR(report.moved.x, 10.0, 0.05);
  EXPECT_GE(slip, 0.0);
  EXPECT_LT(slip, 0.005);
  EXPECT_LT(std::abs(report.moved.y), 0.01);
  EXPECT_NEAR(report.mean_left_nm, kGearFriction_nm, 0.1) << "nothing else holds it back";
}

TEST(Tracks, TurningOnTheSpotIsWithin2PercentOfTheCoulombScrubRatioAtThreeRates) {
  for (const double rate : {0.2, 0.4, 0.8}) {
    TrackedRobot robot(make_flat_world(), {}, open_loop());
    EXPECT_NEAR(turned_over_kinematic(turn_around(robot, rate)), closed_form().ratio, 0.02 * closed_form().ratio)
        << rate;
  }
}

TEST(Tracks, OnHalfTheFrictionTheTurningRatioIsTheSameToWithin2Percent) {
  TrackedRobot robot(make_flat_world(), {}, open_loop(0.4));
  EXPECT_NEAR(turned_over_kinematic(turn_around(robot, 0.4)), closed_form().ratio, 0.02 * closed_form().ratio);
}

// In a curve the two tracks' friction along x must cancel as well, so both slip alike, one ahead and one behind: k is
// that of the turn on the spot, and the middle goes as fast as the mean of the belts. Centres of rotation that do not
// depend on the curve are what Mandow et al. (IROS 2007) measure on real skid-steering vehicles. Left out is v w / (mu
// g), 2 % of the friction at most.
TEST(Tracks, InCurvesOf1And2MetresTheScrubRatioIsThatOfATurnOnTheSpotTo3PercentAndTheMiddleSlipsByLessThan1Percent) {
  for (const double radius_m : {1.0, 2.0}) {
    TrackedRobot robot(make_flat_world(), {}, open_loop());
    const double speed = 0.4, asked = speed / radius_m;
    robot.drive(speed, asked, 2.0);
    double way_m = 0.0, yaw_rad = 0.0, left_m = 0.0, right_m = 0.0;
    for (int step = 0; step < 1000; ++step) {
      const DriveReport report = robot.drive(speed, asked, 0.02);
      way_m += report.moved.x, yaw_rad += report.moved.yaw;
      left_m += report.left_belt_m, right_m += report.right_belt_m;
    }
    EXPECT_NEAR(yaw_rad / ((right_m - left_m) / kGauge_m), closed_form().ratio, 0.03 * closed_form().ratio) << radius_m;
    EXPECT_NEAR(way_m, (left_m + right_m) / 2.0, 0.01 * way_m) << radius_m;
  }
}

// mu N of five wheels along x, at the pitch line, and the gear's friction: 15.1 N m. Under a pyramidal cone sliding at
// an angle a to its axes costs mu N max(|cos a|, |sin a|), which is 2 sqrt(2) / pi = 90 % of mu N on average over a
// turn: 13.7 N m.
TEST(Tracks, TurningTakesTheTorqueOfTheScrubUnderThePyramidalConeToWithin6Percent) {
  TrackedRobot robot(make_flat_world(), {}, open_loop());
  const DriveReport turn = turn_around(robot, 0.4);
  const double round_cone_nm = 0.8 * kWeight_n / 10.0 * closed_form().sum_of_cosines * kPitchRadius_m;
  const double torque_nm = 2.0 * std::sqrt(2.0) / M_PI * round_cone_nm + kGearFriction_nm;
  EXPECT_NEAR(turn.mean_right_nm, torque_nm, 0.06 * torque_nm);
  EXPECT_NEAR(turn.mean_left_nm, -turn.mean_right_nm, 0.2);
}

TEST(Tracks, UnderEllipticConesRatioAndTorqueAreThoseOfTheClosedFormToWithin1Percent) {
  TrackedRobot robot(make_flat_world(), {}, open_loop());
  robot.options().cone = mjCONE_ELLIPTIC;
  const DriveReport turn = turn_around(robot, 0.4);
  const double torque_nm = 0.8 * kWeight_n / 10.0 * closed_form().sum_of_cosines * kPitchRadius_m + kGearFriction_nm;
  EXPECT_NEAR(turned_over_kinematic(turn), closed_form().ratio, 0.01 * closed_form().ratio);
  EXPECT_NEAR(turn.mean_right_nm, torque_nm, 0.01 * torque_nm);
}

// Without it the belts' factor of 1.41 would be out by a fifth on rubble.
TEST(Tracks, WithItsGyroscopeItTurnsAsAskedToWithin2PercentOnTheFlatAnd5PercentOnRubble) {
  TrackedRobot on_flat(make_flat_world()), on_rubble(make_rubble_world(8.0, 8.0));
  on_flat.drive(0.0, 0.4, 3.0);
  EXPECT_NEAR(on_flat.drive(0.0, 0.4, 10.0).moved.yaw, 4.0, 0.08);
  on_rubble.drive(0.0, 0.4, 3.0);
  EXPECT_NEAR(on_rubble.drive(0.0, 0.4, 10.0).moved.yaw, 4.0, 0.20);
}

// While the belts slide, mu g is all that moves the robot, whatever the belts do: they are at 0.5 m/s after 0.63 s, it
// after 1.02 s.
TEST(Tracks, PullingAwayOnIceItIsSpedUpByCoulombFrictionTo3PercentWhileTheBeltsRunAheadAndThenSlipsNoMore) {
  TrackedRobot robot(make_flat_world(), {}, open_loop(0.05));
  const DriveReport first = robot.drive(0.5, 0.0, 0.2);
  const double before_mps = robot.data().qvel[0];
  const DriveReport sliding = robot.drive(0.5, 0.0, 0.6);
  EXPECT_NEAR((robot.data().qvel[0] - before_mps) / 0.6, 0.05 * 9.81, 0.03 * 0.05 * 9.81);
  EXPECT_GT(first.left_belt_m + sliding.left_belt_m, 1.4 * (first.moved.x + sliding.moved.x));
  robot.drive(0.5, 0.0, 1.2);
  const DriveReport after = robot.drive(0.5, 0.0, 5.0);
  EXPECT_NEAR(after.moved.x / after.left_belt_m, 1.0, 0.01);
}

TEST(Tracks, OnIceAgainstAWallTheTicksRunOnWhileTheRobotStands) {
  TrackedRobot robot(make_wall(), {}, open_loop(0.05));
  robot.drive(0.5, 0.0, 8.0);
  const DriveReport report = robot.drive(0.5, 0.0, 5.0);
  EXPECT_NEAR(report.left_belt_m, 2.5, 0.01);
  EXPECT_NEAR(report.moved.x, 0.0, 0.001);
  EXPECT_NEAR(report.moved.y, 0.0, kMaxCreepOnIce * report.left_belt_m);
}

// The wall takes the push; nothing pushes aside: the closed form of the motion is zero.
TEST(Tracks, UnderRoundConesARobotPushingAgainstAWallStaysWithin1MillimetreOnIceAndOnDryGround) {
  for (const double friction : {0.05, 0.8}) {
    TrackedRobot robot(make_wall(), {}, open_loop(friction));
    use_round_cones(robot);
    robot.drive(0.5, 0.0, 8.0);
    const DriveReport report = robot.drive(0.5, 0.0, 5.0);
    EXPECT_NEAR(report.left_belt_m, 2.5, 0.01) << friction;
    EXPECT_NEAR(report.moved.x, 0.0, 0.001) << friction;
    EXPECT_NEAR(report.moved.y, 0.0, 0.001) << friction;
    EXPECT_NEAR(report.moved.yaw, 0.0, 0.001) << friction;
  }
}

TEST(Tracks, OnAnIcySlopeOf10DegreesTheBeltsRunForwardsAndTheRobotSlidesBackAsOnAnInclinedPlane) {
  TrackedRobot robot(make_slope(10.0), {}, open_loop(0.05));
  const double speed = robot.data().qvel[0];
  const DriveReport report = robot.drive(0.5, 0.0, 2.0);
  EXPECT_GT(report.left_belt_m, 0.6);
  // x = (v + a t / 2) t cos 10 with a = -g (sin 10 - 0.05 cos 10) while the belts go the other way over the ground.
  const double a = -9.81 * (std::sin(to_rad(10.0)) - 0.05 * std::cos(to_rad(10.0)));
  EXPECT_NEAR(report.moved.x, 2.0 * speed + 2.0 * a * std::cos(to_rad(10.0)), 0.05 * 2.5);
}

TEST(Tracks, AgainstAWallTheBeltsSlipAt24_8NewtonMetres) {
  TrackedRobot robot(make_wall(), {}, open_loop());
  robot.drive(0.5, 0.0, 8.0);
  const DriveReport report = robot.drive(0.5, 0.0, 5.0);
  const double slip_nm = 0.8 * kWeight_n / 2.0 * kPitchRadius_m + kGearFriction_nm;  // 24.8
  EXPECT_NEAR(report.mean_left_nm, slip_nm, 0.02 * slip_nm);
  EXPECT_NEAR(report.left_belt_m, 2.5, 0.01);
  EXPECT_NEAR(report.moved.x, 0.0, 0.001);
  EXPECT_NEAR(report.moved.y, 0.0, kMaxCreepOnDryGround * report.left_belt_m);
}

TEST(Tracks, MotorsOf15NewtonMetresStallAgainstAWallAndPushWithWhatTheyHave) {
  RobotDescription weak = tracked_description();
  for (JointLimit& limit : weak.joint_limits) limit.effort_nm = 15.0;
  TrackedRobot robot(make_wall(), {}, open_loop(), weak);
  robot.drive(0.5, 0.0, 10.0);
  const DriveReport report = robot.drive(0.5, 0.0, 5.0);
  EXPECT_NEAR(report.mean_left_nm, 15.0, 0.01);
  EXPECT_LT(std::abs(report.left_belt_m), 0.1) << "creep by the contacts' softness only";
  // Between all of the torque and what the gear's friction leaves of it: at rest, friction may help either side.
  const double most_n = 2.0 * 15.0 / kPitchRadius_m, least_n = 2.0 * (15.0 - kGearFriction_nm) / kPitchRadius_m;
  double push_n = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    robot.drive(0.5, 0.0, 0.002);
    push_n += robot.force_on_n("wall") / 500.0;
  }
  EXPECT_GT(push_n, least_n - 5.0);
  EXPECT_LT(push_n, most_n + 5.0);
}

TEST(Tracks, A15DegreeRampIsClimbedAndDescendedForwardsAndBackwards) {
  TrackedRobot robot(make_ramp());
  EXPECT_NEAR(robot.drive(0.5, 0.0, 11.5).climbed_m, 0.776, 0.01);  // 3 m * sin 15
  EXPECT_NEAR(robot.drive(0.5, 0.0, 10.0).climbed_m, -0.776, 0.01);
  const DriveReport back = robot.drive(-0.5, 0.0, 10.5);
  EXPECT_NEAR(back.climbed_m, 0.776, 0.01);
  const DriveReport down = robot.drive(-0.5, 0.0, 10.0);
  EXPECT_NEAR(down.climbed_m, -0.776, 0.01);
  EXPECT_LT(std::abs(robot.T_world_body().position.y()), 0.1);
  EXPECT_FALSE(down.has_fallen);
}

TEST(Tracks, StepsOf8And12CentimetresAreCrossed) {
  for (const double height_m : {0.08, 0.12}) {
    TrackedRobot robot(make_flat_world(
        fmt::format(R"(<geom name="ground_step" type="box" size="1 1 {0}" pos="2 0 {0}"/>)", height_m / 2.0)));
    EXPECT_NEAR(robot.drive(0.3, 0.0, 8.0).climbed_m, height_m, 0.01);
    const DriveReport over = robot.drive(0.3, 0.0, 6.0);
    EXPECT_GT(robot.T_world_body().position.x(), 3.5);
    EXPECT_NEAR(over.climbed_m, -height_m, 0.01);
    EXPECT_FALSE(over.has_fallen);
  }
}

TEST(Tracks, OnASlopeOf10DegreesTheBrakeHoldsItToACreepOfLessThanAMillimetreASecond) {
  TrackedRobot robot(make_slope(10.0));
  robot.stand(1.0);
  const DriveReport report = robot.stand(10.0);
  EXPECT_LT(std::abs(report.moved.x), 0.010);
  EXPECT_NEAR(report.left_belt_m, 0.0, 0.002);
  EXPECT_EQ(report.mean_left_nm, 0.0);
}

TEST(Tracks, TenMetresOfRubbleAreDrivenOnCourseToWithin20CentimetresAndTheBeltsSlip) {
  TrackedRobot robot(make_rubble_world(), {-7.0, 0.0, 0.0});
  const DriveReport report = robot.drive(0.5, 0.0, 20.0);
  const double slip = 1.0 - report.moved.x / ((report.left_belt_m + report.right_belt_m) / 2.0);
  EXPECT_GT(slip, 0.01);
  EXPECT_LT(slip, 0.10);
  EXPECT_LT(std::abs(report.moved.y), 0.2);
  EXPECT_FALSE(report.has_fallen);
}

TEST(Tracks, StandingItsRoadWheelsTouchTheGroundAllTen) {
  TrackedRobot robot(make_flat_world());
  EXPECT_NEAR(robot.stand(0.5).mean_contacts, 10.0, 1e-9);
  EXPECT_NEAR(robot.T_world_body().position.z(), 0.150, 0.002);
}

TEST(Tracks, TurnedOverByAPushItKnowsThatItHasFallen) {
  TrackedRobot robot(make_flat_world());
  EXPECT_FALSE(robot.stand(0.5).has_fallen);
  const int base = mj_name2id(&robot.model(), mjOBJ_BODY, frame_id::kBody);
  mjtNum& rolling_moment_nm = robot.data().xfrc_applied[6 * base + 3];
  rolling_moment_nm = 350.0;
  while (robot.T_world_body().rotation.toRotationMatrix()(2, 2) > 0.0) robot.stand(0.05);
  rolling_moment_nm = 0.0;
  const DriveReport after = robot.stand(0.6);
  EXPECT_GT(after.max_tilt_rad, M_PI / 3.0);
  EXPECT_TRUE(after.has_fallen);
}

}  // namespace
}  // namespace patrol::sim::tracks_test
