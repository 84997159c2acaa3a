#include "sim/as_built/sensor_errors.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "sim/sensors/imu.h"
#include "tests/sim/lidar_scans.h"

namespace patrol::sim::sensor_errors_test {
namespace {

const std::string kWallAhead = box("5.5 0 0", ".5 20 20");

LaserScan scan_with(const LidarErrors& errors, const std::string& world_xml, const LidarSettings& settings = ideal()) {
  const SmallWorld world(world_xml);
  Lidar lidar(settings, world.scene, {}, kRayLidar2d, 1, "lidar", {}, errors);
  std::vector<LaserScan> scans;
  for (Time now{}; scans.empty(); now += kTick) {
    lidar.advance(now, now + kTick, Pose3{}, Pose3{});
    scans = lidar.take_scans();
  }
  return scans.front();
}

double range_ahead_m(const LaserScan& scan) { return static_cast<double>(scan.ranges_m[scan.ranges_m.size() / 2]); }

TEST(LidarErrors, OffsetAndScaleShiftTheRangeOfAWall) {
  EXPECT_NEAR(range_ahead_m(scan_with({}, kWallAhead)), 5.0, 1e-4);
  EXPECT_NEAR(range_ahead_m(scan_with({.range_offset_m = 0.015}, kWallAhead)), 5.015, 1e-4);
  EXPECT_NEAR(range_ahead_m(scan_with({.range_scale = -0.002}, kWallAhead)), 4.990, 1e-4);
}

TEST(LidarErrors, ReflectivityErrorVanishesOnHalfAndIsFullOnATenth) {
  const LidarErrors errors{.reflectivity_m = 0.010};
  EXPECT_NEAR(errors.range_error_m(3.0, 0.5, 1.0), 0.0, 1e-12);
  EXPECT_NEAR(errors.range_error_m(3.0, 0.1, 1.0), 0.010, 1e-12);
  EXPECT_LT(errors.range_error_m(3.0, 1.0, 1.0), 0.0);
}

TEST(LidarErrors, IncidenceErrorGrowsToItsValueAtGrazingIncidence) {
  const LidarErrors errors{.incidence_m = 0.008};
  EXPECT_EQ(errors.range_error_m(3.0, 0.5, 1.0), 0.0);
  EXPECT_NEAR(errors.range_error_m(3.0, 0.5, std::cos(60.0 * kDegree)), 0.004, 1e-12);
}

TEST(LidarErrors, BeamsOfAConeRiseAboveThePlaneInEveryDirection) {
  const LidarErrors errors{.cone_rad = 1.5 * kDegree};
  for (double azimuth = -3.0; azimuth < 3.1; azimuth += 0.5) {
    const Eigen::Vector3d beam = errors.actual_direction({std::cos(azimuth), std::sin(azimuth), 0.0});
    EXPECT_NEAR(std::asin(beam.z()), 1.5 * kDegree, 1e-12);
    EXPECT_NEAR(std::atan2(beam.y(), beam.x()), azimuth, 1e-12);
    EXPECT_NEAR(beam.norm(), 1.0, 1e-12);
  }
}

TEST(LidarErrors, TiltedAxisLowersTheFrontAndRaisesTheRear) {
  const LidarErrors errors{.axis_tilt_y_rad = 0.01};
  EXPECT_NEAR(errors.actual_direction({1.0, 0.0, 0.0}).z(), -0.01, 1e-6);
  EXPECT_NEAR(errors.actual_direction({-1.0, 0.0, 0.0}).z(), 0.01, 1e-6);
  EXPECT_NEAR(errors.actual_direction({0.0, 1.0, 0.0}).z(), 0.0, 1e-6);
}

/// Stamps of scans with a varying rate: the mean period is nominal, its deviation is that of the settings.
TEST(LidarErrors, RevolutionsVaryByOnePercent) {
  const SmallWorld world(kWallAhead);
  LidarSettings settings = ideal();
  settings.beams = 36;
  Lidar lidar(settings, world.scene, {}, kRayLidar2d, 1, "lidar", {}, {.rate_std = 0.01});
  std::vector<double> periods_s;
  double last_s = 0.0;
  for (Time now{}; now < std::chrono::seconds(400); now += kTick) {
    lidar.advance(now, now + kTick, Pose3{}, Pose3{});
    for (const LaserScan& scan : lidar.take_scans()) {
      if (last_s > 0.0) periods_s.push_back(to_seconds(scan.stamp) - last_s);
      last_s = to_seconds(scan.stamp);
      EXPECT_EQ(scan.scan_time_s, 0.1);
    }
  }
  ASSERT_GT(periods_s.size(), 3900U);
  double sum = 0.0, squares = 0.0;
  for (const double period : periods_s) sum += period, squares += period * period;
  const double mean = sum / static_cast<double>(periods_s.size());
  EXPECT_NEAR(mean, 0.1, 0.0005);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(periods_s.size()) - mean * mean), 0.001, 0.0003);
}

TEST(ImuErrors, BiasDistortionAndAccelerationAddUp) {
  const SmallWorld world(R"(<body><freejoint/><geom size="0.1"/><site name="imu"/></body>)");
  ImuSettings settings;
  settings.gyro_noise_density_radps_per_sqrt_hz = settings.gyro_bias_std_radps =
      settings.gyro_bias_random_walk_radps_per_sqrt_s = settings.gyro_resolution_radps = 0.0;
  settings.scale_error_std = settings.misalignment_std_deg = 0.0;
  ImuErrors errors;
  errors.gyro.bias = {0.01, 0.0, -0.02};
  errors.gyro.distortion(2, 2) = 0.005;
  errors.g_sensitivity(2, 2) = 1e-4;
  ImuSensor imu(settings, *world.model, 1, errors);
  const Imu reading = imu.corrupt({0.0, 0.0, 2.0}, {0.0, 0.0, 10.0}, Time{}, 0);
  EXPECT_NEAR(reading.angular_velocity_radps.x(), 0.01, 1e-12);
  EXPECT_NEAR(reading.angular_velocity_radps.z(), 1.005 * (2.0 + 1e-3) - 0.02, 1e-12);
}

TEST(ImuErrors, WarmingReachesTwoThirdsAfterItsTimeConstant) {
  ImuErrors errors;
  errors.warming_k = 10.0;
  errors.warming_time_s = 300.0;
  EXPECT_EQ(errors.temperature_rise_k(Time{}), 0.0);
  EXPECT_NEAR(errors.temperature_rise_k(std::chrono::seconds(300)), 6.321, 1e-3);
  EXPECT_NEAR(errors.temperature_rise_k(std::chrono::hours(2)), 10.0, 1e-6);
}

}  // namespace
}  // namespace patrol::sim::sensor_errors_test
