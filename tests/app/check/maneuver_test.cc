#include <algorithm>
#include <cmath>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/check/maneuver_figures.h"
#include "core/geometry/angles.h"
#include "tests/app/check/straight_record.h"

namespace patrol::app::maneuver_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CheckRobot robot_of(DriveKind kind, double min_turning_radius_m) {
  CheckRobot robot;
  robot.kind = kind;
  robot.limits = {.max_speed_mps = 1.0,
                  .max_yaw_rate_radps = 0.5,
                  .max_acceleration_mps2 = 1.0,
                  .max_yaw_acceleration_radps2 = 2.0,
                  .min_turning_radius_m = min_turning_radius_m};
  return robot;
}

std::vector<std::string> names_of(const std::vector<Maneuver>& maneuvers) {
  std::vector<std::string> names;
  for (const Maneuver& maneuver : maneuvers) names.push_back(maneuver.name);
  return names;
}

const Maneuver& named(const std::vector<Maneuver>& maneuvers, const std::string& name) {
  return *std::ranges::find_if(maneuvers, [&](const Maneuver& each) { return each.name == name; });
}

TEST(CheckManeuvers, ARobotThatTurnsInPlaceDrivesASquare) {
  EXPECT_THAT(names_of(maneuvers_of(robot_of(DriveKind::kTracks, 0.0))),
              ElementsAre("stand", "straight", "square", "turn", "ramp", "steps", "emergency_stop", "slope_stand"));
}

TEST(CheckManeuvers, ACarDrivesCirclesOf1_2And1TimesItsMinimumRadius) {
  const std::vector<Maneuver> maneuvers = maneuvers_of(robot_of(DriveKind::kAckermannWheels, 2.0));
  for (const auto& [name, radius_m] : {std::pair("circle", 2.4), std::pair("turn", 2.0)}) {
    const DriveSegment& segment = named(maneuvers, name).segments.front();
    EXPECT_NEAR(segment.vx_mps / segment.yaw_rate_radps, radius_m, 1e-12) << name;
    EXPECT_NEAR(segment.yaw_rate_radps * segment.duration_s, 2.0 * M_PI, 1e-12) << name;
  }
}

TEST(CheckManeuvers, MecanumWheelsAlsoDrive5MetersSidewaysAt0_6TimesTheirLateralSpeedAndFailFor20PercentLess) {
  CheckRobot robot = robot_of(DriveKind::kMecanumWheels, 0.0);
  robot.limits.max_lateral_speed_mps = 0.5;
  const std::vector<Maneuver> maneuvers = maneuvers_of(robot);
  EXPECT_THAT(names_of(maneuvers), ElementsAre("stand", "straight", "sideways", "square", "turn", "ramp", "steps",
                                               "emergency_stop", "slope_stand"));
  const Maneuver& sideways = named(maneuvers, "sideways");
  EXPECT_NEAR(sideways.segments.front().vy_mps, 0.3, 1e-12);
  EXPECT_NEAR(sideways.segments.front().vy_mps * sideways.segments.front().duration_s, 5.0, 1e-12);
  EXPECT_EQ(sideways.segments.front().vx_mps, 0.0);
  DriveRecord record = test::straight_record(0.0, 0.0, 10.0);
  record.samples.back().T_start_commanded.y = 5.0;
  record.samples.back().T_start_center.y = 4.0;
  EXPECT_THAT(failures_of(robot, sideways, record, sideways.measure(robot, sideways, record)),
              ElementsAre("distance ratio 0.800: 0.900 to 1.100"));
  record.samples.back().T_start_center = {0.6, 5.0, 0.0};
  record.samples.back().yaw_rad = to_rad(8.0);
  EXPECT_THAT(failures_of(robot, sideways, record, sideways.measure(robot, sideways, record)),
              ElementsAre(HasSubstr("forward drift"), HasSubstr("heading drift")));
  robot.max_sideways_drift_rad_per_m = to_rad(14.0);
  EXPECT_THAT(failures_of(robot, sideways, record, sideways.measure(robot, sideways, record)), ElementsAre());
}

TEST(CheckManeuvers, TheCommandsOfTheSquareAdd12MetersAnd360Degrees) {
  double length_m = 0.0, yaw_rad = 0.0;
  const Maneuver square = named(maneuvers_of(robot_of(DriveKind::kLegs, 0.0)), "square");
  for (const DriveSegment& segment : square.segments) {
    length_m += segment.vx_mps * segment.duration_s;
    yaw_rad += segment.yaw_rate_radps * segment.duration_s;
  }
  EXPECT_NEAR(length_m, 12.0, 1e-9);
  EXPECT_NEAR(yaw_rad, 2.0 * M_PI, 1e-9);
}

TEST(CheckManeuvers, AStraightDriveThatSlipsByATenthFailsForItsSlip) {
  const CheckRobot robot = robot_of(DriveKind::kDifferentialWheels, 0.0);
  const Maneuver straight = named(maneuvers_of(robot), "straight");
  DriveRecord record = test::straight_record(0.54, 0.6, 10.0);
  for (DriveSample& sample : record.samples) sample.T_start_commanded.x = 0.56 * sample.time_s;
  const std::vector<std::string> failures =
      failures_of(robot, straight, record, straight.measure(robot, straight, record));
  EXPECT_THAT(failures, ElementsAre("slip ratio 0.100: at most 0.050"));
}

TEST(CheckManeuvers, AFailureOnTheRampOfLowFrictionNamesTheFrictionFirst) {
  const CheckRobot robot = robot_of(DriveKind::kDifferentialWheels, 0.0);
  const Maneuver ramp = named(maneuvers_of(robot), "ramp");
  DriveRecord record = test::straight_record(0.05, 0.6, 30.0);
  record.friction = 0.05;
  const std::vector<std::string> failures = failures_of(robot, ramp, record, ramp.measure(robot, ramp, record));
  ASSERT_GE(failures.size(), 2U);
  EXPECT_EQ(failures[0], "friction 0.050 is below tan 10° = 0.176");
  EXPECT_THAT(failures[1], HasSubstr("reached"));
}

TEST(CheckManeuvers, ARobotThatHasFallenFailsWhateverItsFigures) {
  const CheckRobot robot = robot_of(DriveKind::kLegs, 0.0);
  DriveRecord record = test::straight_record(0.6, 0.6, 2.0);
  record.has_fallen = true;
  EXPECT_THAT(failures_of(robot, named(maneuvers_of(robot), "straight"), record, {}),
              ElementsAre("falls over after 2.0 s"));
}

}  // namespace
}  // namespace patrol::app::maneuver_test
