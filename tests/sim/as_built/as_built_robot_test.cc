#include "sim/as_built/as_built_robot.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "sim/sensors/imu.h"
#include "tests/sim/as_built/drawn_values.h"
#include "tests/sim/as_built/tolerances.h"
#include "tests/sim/small_world.h"
#include "tests/support/moments.h"

namespace patrol::sim::as_built_robot_test {
namespace {

AsBuiltSettings enabled() {
  AsBuiltSettings settings;
  settings.enabled = true;
  return settings;
}

RobotDescription tracked() { return io::load_robot_description(PATROL_SOURCE_DIR "/models/tracked/tracked.urdf"); }

std::map<std::string, double> values_of(const AsBuiltRobot& robot) {
  std::map<std::string, double> values;
  for (const auto& [name, value] : robot.truth({0, 1}).values) values.emplace(name, value);
  return values;
}

/// Values of one quantity for the seeds 1 ... `count`.
template <typename Quantity>
std::vector<double> over_seeds(const AsBuiltSettings& settings, int count, Quantity quantity) {
  const RobotDescription nominal = tracked();
  std::vector<double> values;
  for (int seed = 1; seed <= count; ++seed)
    values.push_back(quantity(AsBuiltRobot(settings, nominal, static_cast<std::uint64_t>(seed))));
  return values;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double max_magnitude(const std::vector<double>& values) {
  double max = 0.0;
  for (const double value : values) max = std::max(max, std::abs(value));
  return max;
}

TEST(AsBuiltRobot, TruthContainsTheBiasesOfTheImuWithWarmingAndGravity) {
  const AsBuiltRobot robot(enabled(), tracked(), 4);
  ImuErrors sensor;
  sensor.gyro.bias.y() = 0.5;
  sensor.accel.bias.z() = -0.25;
  std::map<std::string, double> values;
  for (const auto& [name, value] : robot.truth({}, sensor).values) values.emplace(name, value);
  const ImuErrors imu = robot.imu();
  EXPECT_EQ(values.at("imu.gyro_y_bias_radps"), imu.gyro.bias.y() + 0.5);
  EXPECT_EQ(values.at("imu.accel_z_bias_mps2"), imu.accel.bias.z() - 0.25);
  EXPECT_EQ(values.at("imu.gyro_x_warming_radps"), imu.warming_k * imu.gyro.bias_per_k.x());
  EXPECT_EQ(values.at("imu.accel_x_warming_mps2"), imu.warming_k * imu.accel.bias_per_k.x());
  EXPECT_EQ(values.at("imu.gyro_x_by_gravity_radps"), 9.81 * imu.g_sensitivity(0, 2));
}

// Rolled by 90 degrees, y of the IMU points up.
TEST(AsBuiltRobot, GravityActsOnTheGyroInTheFrameOfARolledImu) {
  RobotDescription rolled = tracked();
  rolled.T_body_sensor.at("imu").rotation = quaternion_from_rpy(0.5 * std::numbers::pi, 0.0, 0.0);
  const AsBuiltRobot robot(enabled(), rolled, 4);
  const std::map<std::string, double> values = values_of(robot);
  for (const auto& [axis, name] : {std::pair(0, "x"), std::pair(1, "y"), std::pair(2, "z")})
    EXPECT_NEAR(values.at(fmt::format("imu.gyro_{}_by_gravity_radps", name)), 9.81 * robot.imu().g_sensitivity(axis, 1),
                1e-12);
}

TEST(AsBuiltRobot, DisabledSettingsGiveTheNominalRobot) {
  const RobotDescription nominal = tracked();
  const AsBuiltRobot robot(AsBuiltSettings{}, nominal, 3);
  EXPECT_FALSE(robot.is_as_built());
  EXPECT_TRUE(robot.truth({0}).values.empty());
  for (const auto& [frame, T_body_sensor] : nominal.T_body_sensor) {
    EXPECT_EQ(robot.actual().T_body(frame).position, T_body_sensor.position) << frame;
    EXPECT_EQ(robot.actual().T_body(frame).rotation.coeffs(), T_body_sensor.rotation.coeffs()) << frame;
  }
  EXPECT_EQ(robot.start({1.0, 2.0, 0.3}).vector(), Eigen::Vector3d(1.0, 2.0, 0.3));
  EXPECT_EQ(robot.clock("lidar").stamp(from_seconds(5.0)), from_seconds(5.0));
  EXPECT_EQ(robot.lidar("lidar").range_error_m(10.0, 0.1, 0.5), 0.0);
  EXPECT_EQ(robot.uwb_delay_m(2), 0.0);
  EXPECT_EQ(robot.foot_friction_scale(), 1.0);
  EXPECT_EQ(robot.tracks().sprocket_scale[1], 1.0);
}

TEST(AsBuiltRobot, SameSeedGivesTheSameRobotAndOtherSeedsOtherRobots) {
  const RobotDescription nominal = tracked();
  const auto first = values_of(AsBuiltRobot(enabled(), nominal, 1));
  const auto again = values_of(AsBuiltRobot(enabled(), nominal, 1));
  const auto other = values_of(AsBuiltRobot(enabled(), nominal, 2));
  EXPECT_EQ(first, again);
  for (const auto& [name, value] : first) {
    if (name.starts_with("tem_mount")) continue;
    EXPECT_NE(value, other.at(name)) << name;
  }
}

TEST(AsBuiltRobot, MountingErrorsAreUniformWithinThreeMillimetersAndThreeTenthsOfADegree) {
  constexpr int kSeeds = 1000;
  const std::vector<double> x_m =
      over_seeds(enabled(), kSeeds, [](const AsBuiltRobot& robot) { return values_of(robot).at("lidar.x_m"); });
  const std::vector<double> yaw_rad =
      over_seeds(enabled(), kSeeds, [](const AsBuiltRobot& robot) { return values_of(robot).at("lidar.yaw_rad"); });
  EXPECT_LE(max_magnitude(x_m), 0.003);
  EXPECT_GT(max_magnitude(x_m), 0.00295);
  EXPECT_NEAR(rms(x_m), 0.003 / std::sqrt(3.0), 0.0001);
  EXPECT_LE(max_magnitude(yaw_rad), 0.3 * kDegree * 1.001);
  EXPECT_NEAR(rms(yaw_rad), 0.3 * kDegree / std::sqrt(3.0), 0.0002);
}

TEST(AsBuiltRobot, PlacementErrorStaysWithinTwoCentimetersAndHalfADegree) {
  const auto start = [](const AsBuiltRobot& robot) { return robot.start(Pose2{}); };
  const std::vector<double> x_m = over_seeds(enabled(), 500, [&](const auto& robot) { return start(robot).x; });
  const std::vector<double> yaw_rad = over_seeds(enabled(), 500, [&](const auto& robot) { return start(robot).yaw; });
  EXPECT_LE(max_magnitude(x_m), 0.02);
  EXPECT_NEAR(rms(x_m), 0.02 / std::sqrt(3.0), 0.001);
  EXPECT_LE(max_magnitude(yaw_rad), 0.5 * kDegree);
  EXPECT_NEAR(rms(yaw_rad), 0.5 * kDegree / std::sqrt(3.0), 0.0005);
}

/// Standard deviations of the sheet: 0.5 deg/s, 20 mg, 1 % and 0.05 deg at two standard deviations. The section
/// sensors.imu has a share in them.
TEST(AsBuiltRobot, ConstantErrorsOfAnImuAddUpToItsDataSheet) {
  constexpr double kStandardGravity_mps2 = 9.80665;
  const ImuSettings share;
  const ImuTolerances rest;
  EXPECT_NEAR(std::hypot(share.gyro_bias_std_radps, rest.gyro_bias_std_radps), 0.5 * kDegree, 0.003 * 0.5 * kDegree);
  EXPECT_NEAR(std::hypot(share.accel_bias_std_mps2, rest.accel_bias_std_mps2), 0.02 * kStandardGravity_mps2, 0.0006);
  EXPECT_NEAR(std::hypot(share.scale_error_std, rest.scale_std), 0.01 / 2.0, 0.00002);
  EXPECT_NEAR(std::hypot(share.misalignment_std_deg, rest.misalignment_std_deg), 0.05 / 2.0, 1e-12);

  const SmallWorld world(R"(<body><freejoint/><geom size="0.1"/><site name="imu"/></body>)");
  ImuSettings settings;
  settings.gyro_noise_density_radps_per_sqrt_hz = settings.gyro_bias_random_walk_radps_per_sqrt_s =
      settings.gyro_resolution_radps = 0.0;
  test::Moments bias, scale, misalignment;
  const RobotDescription robot = tracked();
  constexpr int kSeeds = 1000;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    ImuSensor imu(settings, *world.model, seed, AsBuiltRobot(enabled(), robot, seed).imu());
    const Eigen::Vector3d still = imu.corrupt({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, Time{}, 0).angular_velocity_radps;
    const Eigen::Vector3d turning =
        imu.corrupt({0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, Time{}, 1).angular_velocity_radps - still;
    bias.add(still.z());
    scale.add(turning.z() - 1.0);
    misalignment.add(turning.x());
  }
  const double relative = 4.0 / std::sqrt(2.0 * kSeeds);
  EXPECT_NEAR(bias.std() / (0.5 * kDegree), 1.0, relative);
  EXPECT_NEAR(scale.std() / 0.005, 1.0, relative);
  EXPECT_NEAR(misalignment.std() / (0.025 * kDegree), 1.0, relative);
}

TEST(AsBuiltRobot, LidarConeIsOneSided) {
  const std::vector<double> cone =
      over_seeds(enabled(), 500, [](const AsBuiltRobot& robot) { return robot.lidar("lidar").cone_rad; });
  EXPECT_GE(*std::min_element(cone.begin(), cone.end()), 0.0);
  EXPECT_LT(*std::min_element(cone.begin(), cone.end()), 0.02 * kDegree);
  EXPECT_LE(*std::max_element(cone.begin(), cone.end()), 1.5 * kDegree);
  EXPECT_GT(*std::max_element(cone.begin(), cone.end()), 1.48 * kDegree);
}

/// Uniform between half and all of the tolerance: mean 3/4 and standard deviation 1 / (4 sqrt(3)) of it.
TEST(AsBuiltRobot, ThePlayOfEachJointOfEachRobotIsBetweenHalfAndAllOfItsTolerance) {
  const double tolerance_rad = to_rad(JointTolerances{}.play_deg);
  const RobotDescription quadruped = io::load_robot_description(PATROL_SOURCE_DIR "/models/quadruped/quadruped.urdf");
  test::Moments play, difference;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const std::vector<double> joints = AsBuiltRobot(enabled(), quadruped, seed).joints().play_rad;
    ASSERT_EQ(joints.size(), 12U);
    for (const double play_rad : joints) play.add(play_rad / tolerance_rad);
    difference.add((joints[1] - joints[0]) / tolerance_rad);
  }
  EXPECT_GE(play.smallest, 0.5);
  EXPECT_LT(play.smallest, 0.51);
  EXPECT_LE(play.largest, 1.0);
  EXPECT_GT(play.largest, 0.99);
  const double std = 0.25 / std::sqrt(3.0);
  EXPECT_NEAR(play.mean(), 0.75, 4.0 * std / std::sqrt(play.count));
  EXPECT_NEAR(play.std(), std, 0.05 * std);
  EXPECT_NEAR(difference.std(), std * std::sqrt(2.0), 0.2 * std) << "joints of one robot are independent";
}

/// Every number of section `as_built`, set to its lowest value, changes each value of its own and no bit of any other.
/// For a tolerance, the value becomes that of the nominal robot.
TEST(AsBuiltRobot, RemovingOneTermKeepsAllOthers) {
  RobotDescription robot = tracked();
  robot.wheels.resize(2);
  const DrawnValues all(AsBuiltRobot(enabled(), robot, 7)), nominal((AsBuiltRobot(robot)));
  AsBuiltSettings settings = enabled();
  int num_numbers = 0;
  for_each_tolerance(settings, [&](const std::string& removed, double&, const Limits& limits) {
    if (removed.find(".measured_") != std::string::npos) return;  // the mean of a draw, not its tolerance
    const DrawnValues fewer(AsBuiltRobot(without(enabled(), removed), robot, 7));
    int num_own = 0;
    for (const auto& [name, value] : all.values()) {
      const std::string owner = name.substr(0, name.find(':'));
      const bool is_own =
          owner == removed || (owner == DrawnValues::kUwbDelays && owner.find(removed) != std::string::npos);
      if (!is_own || name.find("tem_mount") != std::string::npos) {
        EXPECT_EQ(fewer.values().at(name), value) << removed << " changes " << name;
        continue;
      }
      ++num_own;
      EXPECT_NE(fewer.values().at(name), value) << removed << " does not change " << name;
      if (owner == DrawnValues::kUwbDelays) continue;
      EXPECT_EQ(fewer.values().at(name), is_tolerance(removed) ? nominal.values().at(name) : limits.min) << name;
    }
    EXPECT_GT(num_own, 0) << removed << ": add its values to DrawnValues";
    ++num_numbers;
  });
  EXPECT_GT(num_numbers, 40);
}

/// The delay of an anchor is the sum of its own and the robot's.
TEST(AsBuiltRobot, WheelsAreUniformWithin1PercentOfTheirRadiusAnd2MillimetersOfTheirGauge) {
  const RobotDescription wheeled = io::load_robot_description(PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf");
  double largest = 0.0, largest_gauge_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const WheelErrors errors = AsBuiltRobot(enabled(), wheeled, seed).wheels();
    ASSERT_EQ(errors.radius_scale.size(), 4U);
    for (const double scale : errors.radius_scale) largest = std::max(largest, std::abs(scale - 1.0));
    largest_gauge_m = std::max(largest_gauge_m, std::abs(errors.gauge_error_m));
  }
  EXPECT_LE(largest, 0.01);
  EXPECT_GT(largest, 0.0095);
  EXPECT_LE(largest_gauge_m, 0.002);
  EXPECT_GT(largest_gauge_m, 0.0019);
}

TEST(AsBuiltRobot, AntennaDelaysAreDrawnOnTheirOwn) {
  const RobotDescription robot = tracked();
  const AsBuiltRobot all(enabled(), robot, 7), anchors(without(enabled(), "uwb.tag_delay_m"), robot, 7),
      tag(without(enabled(), "uwb.anchor_delay_m"), robot, 7);
  EXPECT_NE(anchors.uwb_delay_m(0), anchors.uwb_delay_m(1));
  EXPECT_EQ(tag.uwb_delay_m(0), tag.uwb_delay_m(1));
  for (const int anchor : {0, 1, 5}) {
    EXPECT_EQ(all.uwb_delay_m(anchor), anchors.uwb_delay_m(anchor) + tag.uwb_delay_m(anchor));
  }
}

TEST(AsBuiltRobot, MountErrorsOfTheTruthAreThoseOfTheActualSensors) {
  AsBuiltSettings settings = enabled();
  settings.mounting.angle_deg = 20.0;
  const AsBuiltRobot robot(settings, tracked(), 7);
  for (const auto& [frame, T_body_sensor] : robot.actual().T_body_sensor) {
    const Pose3 T_body_read = robot.nominal().T_body(frame) * mount_error(robot.truth({}), frame);
    EXPECT_TRUE(T_body_read.position.isApprox(T_body_sensor.position, 1e-12)) << frame;
    EXPECT_NEAR(T_body_read.rotation.angularDistance(T_body_sensor.rotation), 0.0, 1e-7) << frame;
  }
  EXPECT_EQ(mount_error({}, "lidar").position, Eigen::Vector3d(0.0, 0.0, 0.0));
}

TEST(AsBuiltRobot, AMeasuredErrorOfTheLidarShiftsTheDraw) {
  AsBuiltSettings settings = enabled();
  const AsBuiltRobot drawn(settings, tracked(), 7);
  settings.lidar.measured_range_offset_m = 0.02;
  const AsBuiltRobot shifted(settings, tracked(), 7);
  EXPECT_NEAR(shifted.lidar("lidar").range_offset_m - drawn.lidar("lidar").range_offset_m, 0.02, 1e-15);
  EXPECT_EQ(shifted.lidar("lidar").range_scale, drawn.lidar("lidar").range_scale);
  EXPECT_EQ(shifted.lidar("lidar3d").range_offset_m, drawn.lidar("lidar3d").range_offset_m);  // another device
}

TEST(AsBuiltRobot, NegativeToleranceIsRefused) {
  AsBuiltSettings settings = enabled();
  settings.clock.offset_s = -0.1;
  EXPECT_THROW(AsBuiltRobot(settings, tracked(), 1), InputError);
}

}  // namespace
}  // namespace patrol::sim::as_built_robot_test
