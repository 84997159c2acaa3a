#include "app/check/check_robot.h"

#include <cmath>
#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "io/files/atomic_file.h"
#include "tests/support/temporary_file.h"
#include "tests/support/wheeled_urdf.h"

namespace patrol::app::check_robot_test {
namespace {

CheckRobot load(const std::string& name, const std::vector<std::string>& overrides = {}) {
  return load_check_robot(name, overrides, {}, PATROL_SOURCE_DIR);
}

std::string error_of(const std::string& name, const std::vector<std::string>& overrides) {
  try {
    load(name, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckRobot, TheDriveIsThatOfTheDescription) {
  EXPECT_EQ(load("quadruped").kind, DriveKind::kLegs);
  EXPECT_EQ(load("tracked").kind, DriveKind::kTracks);
  EXPECT_EQ(load("wheeled").kind, DriveKind::kDifferentialWheels);
}

TEST(CheckRobot, TheLimitsAreThoseOfTheFirmware) {
  const DriveLimits limits =
      load("wheeled", {"wheel_drive.max_speed_mps=0.7", "wheel_drive.max_acceleration_mps2=0.4"}).limits;
  EXPECT_DOUBLE_EQ(limits.max_speed_mps, 0.7);
  EXPECT_DOUBLE_EQ(limits.max_acceleration_mps2, 0.4);
  EXPECT_EQ(limits.min_turning_radius_m, 0.0);
}

// 8 rad/s without load and a radius of 0.1651 m: 1.32 m/s.
TEST(CheckRobot, WheelsAreNoFasterThanTheirMotorsWithoutLoad) {
  EXPECT_NEAR(load("wheeled", {"wheel_drive.max_speed_mps=5"}).limits.max_speed_mps, 8.0 * 0.1651, 1e-9);
}

TEST(CheckRobot, TheYawRateOfSkidSteeringIsLimitedByTheSpeedOfItsSides) {
  const CheckRobot robot = load("wheeled", {"wheel_drive.max_speed_mps=0.3"});
  const double effective_gauge_m = differential_geometry(robot.description).gauge_m * skid_ratio(robot.description);
  EXPECT_NEAR(robot.limits.max_yaw_rate_radps, 2.0 * 0.3 / effective_gauge_m, 1e-9);
}

// Radii of 1 % above and below: 0.02 / gauge, and by skid steering 1.8 times less.
TEST(CheckRobot, TheLimitOfTheHeadingDriftIs1DegreePerMeterOrThatOfOppositeRadiiOfTheSides) {
  EXPECT_NEAR(to_deg(load("wheeled").max_heading_drift_rad_per_m), 1.11, 0.01);
  EXPECT_NEAR(to_deg(load("wheeled", {"as_built.wheels.radius_scale=0.03"}).max_heading_drift_rad_per_m), 3.34, 0.02);
  EXPECT_NEAR(to_deg(load("wheeled", {"as_built.wheels.radius_scale=0.002"}).max_heading_drift_rad_per_m), 1.0, 1e-9);
  EXPECT_NEAR(to_deg(load("tracked").max_heading_drift_rad_per_m), 1.0, 1e-9);
}

// Rollers at 30 degrees to the axle: the wheels turn faster by 1 / tan(30) when the robot drives to the side.
TEST(CheckRobot, TheLimitsOfTheHeadingDriftOfMecanumWheelsAreThoseOfOppositeRadii) {
  const std::vector<std::string> mecanum = {"wheel_drive.type=mecanum", "wheel_drive.roller_angle_rad=0.5235987756"};
  const auto with_radii = [&mecanum](const std::string& radius_scale) {
    std::vector<std::string> overrides = mecanum;
    overrides.push_back("as_built.wheels.radius_scale=" + radius_scale);
    return load("wheeled", overrides);
  };
  const CheckRobot robot = with_radii("0.04");
  const double drift = 0.08 / (differential_geometry(robot.description).gauge_m * skid_ratio(robot.description));
  EXPECT_NEAR(robot.max_heading_drift_rad_per_m, drift, 1e-9);
  EXPECT_NEAR(robot.max_sideways_drift_rad_per_m, std::sqrt(3.0) * drift, 1e-6);
  EXPECT_NEAR(to_deg(with_radii("0.002").max_sideways_drift_rad_per_m), 1.0, 1e-9);
  EXPECT_NEAR(to_deg(load("wheeled").max_sideways_drift_rad_per_m), 1.0, 1e-9);
}

/// Wheeled robot with a middle axle, in a folder of its own.
CheckRobot six_wheels(const std::vector<std::string>& overrides) {
  const test::TemporaryFolder root;
  test::UrdfRobot robot = test::skid_steer_urdf(1.2, 1.1);
  for (const double y_m : {0.55, -0.55})
    robot.wheels.push_back({.name = y_m > 0.0 ? "ml" : "mr", .x_m = 0.0, .y_m = y_m});
  std::filesystem::create_directories(root / "models/six");
  io::save_text(root / "models/six/six.urdf", robot.text());
  return load_check_robot("six", overrides, {}, root / "");
}

// Three standard deviations of the gauge ratio: 3 * 0.0216 / 1.574 for radii with 0.1 % and tires that deflect by 2 %.
TEST(CheckRobot, TheToleranceOfTheYawRateOfSixWheelsHasThatOfTheirRadii) {
  EXPECT_EQ(load("wheeled").yaw_tolerance, 0.15);
  EXPECT_EQ(six_wheels({"as_built.enabled=false"}).yaw_tolerance, 0.15);
  const double radii = 3.0 * 0.0216 / 1.574 * 10.0 / std::sqrt(3.0);
  EXPECT_NEAR(six_wheels({}).yaw_tolerance, 0.15 + radii, 0.005);
  EXPECT_NEAR(six_wheels({"wheel_drive.tire_deflection_ratio=0.04"}).yaw_tolerance, 0.15 + 0.5 * radii, 0.005);
}

TEST(CheckRobot, OnlyTheSensorsOfTheFirmwareAreOn) {
  const sim::SensorSuiteSettings sensors = load("tracked").simulator.sensors;
  EXPECT_FALSE(sensors.lidar.enabled);
  EXPECT_FALSE(sensors.depth_camera.enabled);
  EXPECT_TRUE(sensors.hall.enabled);
}

TEST(CheckRobot, APresetFileSetsTheLidarAndItsTolerances) {
  const test::TemporaryFolder folder;
  const std::string file = folder / "mine.yaml";
  test::write_bytes(file, "lidar: {preset: tim571, beams: 90}\nas_built: {noise_ratio: 0.5}\n");
  const CheckRobot robot = load("wheeled", {"sensors.lidar.preset=" + file});
  ASSERT_EQ(robot.lidars.size(), 1U);
  EXPECT_EQ(robot.lidars[0].settings.preset, "tim571");
  EXPECT_EQ(robot.lidars[0].settings.beams, 90);
  EXPECT_EQ(robot.simulator.as_built.lidar.noise_ratio, 0.5);
  EXPECT_EQ(load("wheeled", {"sensors.lidar.preset=tim571"}).simulator.as_built.lidar.range_offset_m, 0.06);
}

TEST(CheckRobot, AMountSwitchesItsSensorOnAndAppliesItsPreset) {
  const CheckRobot robot = load("wheeled", {"mounts=[{frame: lidar_rear, x_m: -0.4, z_m: 0.4, preset: utm30lx}]"});
  ASSERT_EQ(robot.lidars.size(), 2U);
  EXPECT_EQ(robot.lidars[1].frame, "lidar_rear");
  EXPECT_EQ(robot.lidars[1].settings.preset, "utm30lx");
}

TEST(CheckRobot, ASensorThatTheSettingsEnableAndTheRobotLacksIsRefused) {
  EXPECT_THAT(error_of("wheeled", {"sensors.lidar3d.enabled=true"}),
              testing::HasSubstr("patrol check: wheeled has no lidar3d"));
}

TEST(CheckRobot, AnUnknownRobotIsRefusedWithTheKnownOnes) {
  EXPECT_THAT(error_of("unknown", {}), testing::HasSubstr("(known: cart, quadruped, tracked, wheeled)"));
}

TEST(CheckRobot, AnUnknownSettingIsRefusedWithItsKey) {
  EXPECT_THAT(error_of("wheeled", {"wheel_drive.frictoin=0.1"}),
              testing::HasSubstr("--set wheel_drive.frictoin=0.1: unknown key"));
}

// The steering of the cart, which reaches 0.55 rad to both sides, without the side to the right.
TEST(CheckRobot, ARobotThatSteersToOneSideOnlyIsRefused) {
  const test::TemporaryFolder data;
  std::filesystem::create_directory(data / "worlds");
  std::filesystem::create_directory(data / "models");
  std::filesystem::copy(std::filesystem::path(PATROL_SOURCE_DIR) / "models/cart", data / "models/cart",
                        std::filesystem::copy_options::recursive);
  const std::filesystem::path file = data / "models/cart/cart.urdf";
  const std::string text = std::regex_replace(io::load_text(file), std::regex(R"(lower="-0\.[0-9]+")"), R"(lower="0")");
  test::write_bytes(file, text);
  try {
    load_check_robot("cart", {}, {}, data.path());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("robot cart: the steering joints reach only circles of"));
  }
}

TEST(CheckRobot, TheSeedOfTheCallReplacesThatOfTheSettings) {
  EXPECT_EQ(load_check_robot("wheeled", {"seed=5"}, {}, PATROL_SOURCE_DIR).seed, 5U);
  EXPECT_EQ(load_check_robot("wheeled", {"seed=5"}, 7, PATROL_SOURCE_DIR).seed, 7U);
}

}  // namespace
}  // namespace patrol::app::check_robot_test
