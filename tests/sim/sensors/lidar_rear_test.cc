#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim/sensors/sensor_suite.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::lidar_rear_test {
namespace {

/// A room of 6 m by 4 m around a robot at its center.
const std::string kRoom = R"(
    <geom type="box" pos="3.5 0 1" size="0.5 4 2" rgba="1 1 1 1"/><geom type="box" pos="-3.5 0 1" size="0.5 4 2" rgba="1 1 1 1"/>
    <geom type="box" pos="0 2.5 1" size="4 0.5 2" rgba="1 1 1 1"/><geom type="box" pos="0 -2.5 1" size="4 0.5 2" rgba="1 1 1 1"/>
    <body name="base_link" pos="0 0 1"><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/><site name="imu"/></body>)";

const Pose3 kFront{{0.30, 0.05, 0.2}, Eigen::Quaterniond::Identity()};
const Pose3 kRear{{-0.35, -0.10, 0.1}, quaternion_from_yaw(std::numbers::pi)};

LidarSettings without_errors() {
  LidarSettings settings;
  settings.beams = 360;
  settings.range_noise_std_m = settings.range_quantization_m = settings.angle_noise_std_deg = 0.0;
  settings.beam_width_deg = settings.dropout_probability = 0.0;
  settings.max_incidence_deg = 90.0;
  settings.max_range_10pct_m = 0.0;
  return settings;
}

SensorSuiteSettings lidars_only(const LidarSettings& front, const LidarSettings& rear) {
  SensorSuiteSettings settings;
  settings.imu.enabled = settings.joint_encoders.enabled = settings.foot_contact.enabled = false;
  settings.tdlas.enabled = settings.gnss.enabled = settings.hall.enabled = false;
  settings.lidar = front;
  settings.lidar_rear = rear;
  return settings;
}

std::vector<SensorMessage> stand(const SensorSuiteSettings& settings, double seconds) {
  RobotDescription robot;
  robot.T_body_sensor = {{"lidar", kFront}, {"lidar_rear", kRear}, {"imu", Pose3{}}};
  SmallWorld world(kRoom);
  SensorSuite suite(settings, AsBuiltRobot({}, robot, 1), *world.model, *world.model,
                    GasPlume(Eigen::Vector3d::Zero(), 0.0, {}), {}, 1);
  std::vector<SensorMessage> messages;
  for (Time now{}; now <= from_seconds(seconds); now += std::chrono::milliseconds(2)) {
    suite.step(*world.model, *world.data, now);
    for (SensorMessage& message : suite.take_due(now)) messages.push_back(std::move(message));
  }
  return messages;
}

template <typename Scan>
std::vector<Scan> scans_of(const std::vector<SensorMessage>& messages) {
  std::vector<Scan> scans;
  for (const SensorMessage& message : messages) {
    if (const auto* scan = std::get_if<Scan>(&message)) scans.push_back(*scan);
  }
  return scans;
}

/// Ranges of a scan with a number for beams without a return, which compare unequal to themselves.
std::vector<float> comparable(const LaserScan& scan) {
  std::vector<float> ranges_m = scan.ranges_m;
  for (float& range_m : ranges_m) {
    if (std::isnan(range_m)) range_m = -1.0f;
  }
  return ranges_m;
}

/// Distance to the walls of the room by geometry.
double wall_distance_m(const Pose3& T_room_lidar, double angle_rad) {
  const Eigen::Vector3d direction =
      T_room_lidar.rotation * Eigen::Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0.0);
  const auto along = [](double from, double step, double half) {
    if (std::abs(step) < 1e-12) return std::numeric_limits<double>::infinity();
    return ((step > 0.0 ? half : -half) - from) / step;
  };
  return std::min(along(T_room_lidar.position.x(), direction.x(), 3.0),
                  along(T_room_lidar.position.y(), direction.y(), 2.0));
}

void expect_walls(const LaserScan& scan, const Pose3& T_room_lidar) {
  ASSERT_EQ(scan.ranges_m.size(), 360U);
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); ++beam) {
    const double angle_rad = scan.angle_min_rad + static_cast<double>(beam) * scan.angle_increment_rad;
    EXPECT_NEAR(scan.ranges_m[beam], wall_distance_m(T_room_lidar, angle_rad), 1e-4) << "beam " << beam;
  }
}

TEST(LidarRear, BothScansOfARobotWithTwoLidarsHaveTheDistancesOfTheWallsTo100Micrometers) {
  const std::vector<SensorMessage> messages = stand(lidars_only(without_errors(), without_errors()), 1.05);
  const auto front = scans_of<LaserScan>(messages);
  const auto rear = scans_of<RearLaserScan>(messages);
  ASSERT_GE(front.size(), 9U);
  ASSERT_EQ(rear.size(), front.size());
  expect_walls(front.back(), kFront);
  expect_walls(rear.back(), kRear);
}

TEST(LidarRear, HasARandomStreamOfItsOwnAndChangesNoScanOfTheFirstLidar) {
  LidarSettings noisy;
  noisy.beams = 360;
  LidarSettings off = noisy;
  off.enabled = false;
  const auto alone = scans_of<LaserScan>(stand(lidars_only(noisy, off), 0.55));
  const std::vector<SensorMessage> both = stand(lidars_only(noisy, noisy), 0.55);
  const auto front = scans_of<LaserScan>(both);
  const auto rear = scans_of<RearLaserScan>(both);
  ASSERT_EQ(front.size(), alone.size());
  ASSERT_GE(front.size(), 4U);
  for (std::size_t i = 0; i < front.size(); ++i) EXPECT_EQ(comparable(front[i]), comparable(alone[i]));
  std::size_t num_equal_errors = 0;
  for (std::size_t beam = 0; beam < 360; ++beam) {
    const double angle_rad = rear[0].angle_min_rad + static_cast<double>(beam) * rear[0].angle_increment_rad;
    const double front_error = front[0].ranges_m[beam] - wall_distance_m(kFront, angle_rad),
                 rear_error = rear[0].ranges_m[beam] - wall_distance_m(kRear, angle_rad);
    if (std::abs(front_error - rear_error) < 1e-6) ++num_equal_errors;
  }
  EXPECT_LT(num_equal_errors, 20U);
}

TEST(LidarRear, IsSilentUnlessItIsEnabled) {
  EXPECT_TRUE(
      scans_of<RearLaserScan>(stand(lidars_only(without_errors(), SensorSuiteSettings{}.lidar_rear), 0.5)).empty());
}

}  // namespace
}  // namespace patrol::sim::lidar_rear_test
