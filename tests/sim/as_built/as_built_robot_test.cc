#include "sim/as_built/as_built_robot.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/urdf.h"

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

TEST(AsBuiltRobot, GyroBiasOfTheDataSheetHasHalfADegreePerSecond) {
  const std::vector<double> bias =
      over_seeds(enabled(), 1000, [](const AsBuiltRobot& robot) { return robot.imu().gyro.bias.z(); });
  EXPECT_NEAR(rms(bias), 0.5 * kDegree, 0.03 * kDegree);
}

TEST(AsBuiltRobot, LidarConeIsOneSided) {
  const std::vector<double> cone =
      over_seeds(enabled(), 500, [](const AsBuiltRobot& robot) { return robot.lidar("lidar").cone_rad; });
  EXPECT_GE(*std::min_element(cone.begin(), cone.end()), 0.0);
  EXPECT_LT(*std::min_element(cone.begin(), cone.end()), 0.02 * kDegree);
  EXPECT_LE(*std::max_element(cone.begin(), cone.end()), 1.5 * kDegree);
  EXPECT_GT(*std::max_element(cone.begin(), cone.end()), 1.48 * kDegree);
}

/// Every tolerance that is 0 removes its own term only.
TEST(AsBuiltRobot, RemovingOneTermKeepsAllOthers) {
  const RobotDescription nominal = tracked();
  const auto all = values_of(AsBuiltRobot(enabled(), nominal, 7));
  AsBuiltSettings settings = enabled();
  settings.mounting.angle_deg = 0.0;
  settings.uwb.tag_delay_m = 0.0;
  const auto fewer = values_of(AsBuiltRobot(settings, nominal, 7));
  EXPECT_EQ(fewer.at("lidar.yaw_rad"), 0.0);
  EXPECT_EQ(fewer.at("uwb.anchor_0.delay_m") - fewer.at("uwb.anchor_1.delay_m"),
            AsBuiltRobot(settings, nominal, 7).uwb_delay_m(0) - AsBuiltRobot(settings, nominal, 7).uwb_delay_m(1));
  EXPECT_NEAR(all.at("uwb.anchor_0.delay_m") - all.at("uwb.anchor_1.delay_m"),
              fewer.at("uwb.anchor_0.delay_m") - fewer.at("uwb.anchor_1.delay_m"), 1e-15);
  for (const auto& [name, value] : all) {
    if (name.ends_with("_rad") && !name.starts_with("placement")) continue;
    if (name.starts_with("uwb.anchor")) continue;
    EXPECT_NEAR(fewer.at(name), value, 1e-15) << name;
  }
}

TEST(AsBuiltRobot, NegativeToleranceIsRefused) {
  AsBuiltSettings settings = enabled();
  settings.clock.offset_s = -0.1;
  EXPECT_THROW(AsBuiltRobot(settings, tracked(), 1), InputError);
}

}  // namespace
}  // namespace patrol::sim::as_built_robot_test
