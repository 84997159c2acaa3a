#include "localize/calibration/online_calibrator.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "localize/scan_leveler.h"

namespace patrol::localize::online_calibrator_test {
namespace {

const Pose3 kLidar{{0.1, 0.0, 0.2}, Eigen::Quaterniond::Identity()};
constexpr int kBeams = 720;

/// Walks around in a room of 12 m x 8 m, turning with the oscillation of a gait.
Pose3 walking(Time stamp) {
  const double t = to_seconds(stamp);
  return {{2.0 * std::sin(0.3 * t), 1.5 * std::cos(0.23 * t), 0.0},
          quaternion_from_yaw(0.8 * std::sin(0.5 * t) + 0.02 * std::sin(17.45 * t))};
}

double range_in_room(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const auto meet = [](double wall, double at, double speed) {
    const double distance = speed > 0.0 ? wall - at : wall + at;
    return std::abs(speed) > 1e-9 ? distance / std::abs(speed) : std::numeric_limits<double>::infinity();
  };
  return std::min(meet(6.0, from.x(), direction.x()), meet(4.0, from.y(), direction.y()));
}

LaserScan scan_room(Time start, const Pose3& T_body_lidar, const RandomStream& random, std::uint64_t number) {
  LaserScan scan{.stamp = start,
                 .angle_min_rad = -std::numbers::pi,
                 .angle_increment_rad = 2.0 * std::numbers::pi / kBeams,
                 .time_increment_s = 0.1 / kBeams,
                 .scan_time_s = 0.1,
                 .range_min_m = 0.05,
                 .range_max_m = 30.0,
                 .ranges_m = {},
                 .intensities = {}};
  for (int beam = 0; beam < kBeams; ++beam) {
    const Pose3 T = walking(start + from_seconds(beam * scan.time_increment_s)) * T_body_lidar;
    const double azimuth = scan.angle_min_rad + beam * scan.angle_increment_rad;
    const double range_m =
        range_in_room(T.position, T.rotation * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0));
    scan.ranges_m.push_back(
        static_cast<float>(range_m + 0.01 * random.normal(number, static_cast<std::uint64_t>(beam))));
  }
  return scan;
}

struct Result {
  CalibrationEstimate estimate;
  ScanCorrection applied;
  TimeOffset offset;
};

/// Runs the calibration over `duration_s` of scans with late stamps and a turned lidar.
Result run(double offset_s, double lidar_yaw_rad, double duration_s) {
  OnlineCalibratorSettings settings;
  OnlineCalibrator calibrator(settings, kLidar, Pose3{}, {}, {});
  ScanLeveler leveler(kLidar, {});
  const Pose3 T_body_lidar{kLidar.position, quaternion_from_yaw(lidar_yaw_rad)};
  const RandomStream random(5, "room");
  Result result;
  const PoseLookup odometry = [](Time stamp) { return std::optional(walking(stamp)); };
  for (int k = 0; k * 0.1 < duration_s; ++k) {
    LaserScan scan = scan_room(from_seconds(1.0 + 0.1 * k), T_body_lidar, random, static_cast<std::uint64_t>(k));
    scan.stamp += from_seconds(offset_s);
    result.applied = calibrator.next_correction(scan.stamp);
    scan.stamp -= from_seconds(result.applied.time_offset_s);
    leveler.set_lidar_pose({kLidar.position, quaternion_from_yaw(result.applied.lidar_yaw_rad)});
    const std::optional<LevelScan> level = leveler.level(scan, odometry, 0.3);
    calibrator.add(*level, {.stamp = level->stamp,
                            .duration_s = to_seconds(level->stamp - scan.stamp),
                            .T_odom_begin = to_pose2(walking(scan.stamp)),
                            .T_odom_end = to_pose2(walking(level->stamp)),
                            .applied_time_offset_s = result.applied.time_offset_s,
                            .applied_lidar_yaw_rad = result.applied.lidar_yaw_rad});
    result.estimate = calibrator.estimate(scan.stamp);
    result.offset = calibrator.time_offset(scan.stamp);
  }
  return result;
}

TEST(OnlineCalibrator, FindsAndAppliesTimeOffsetAndLidarYaw) {
  const Result result = run(-0.02, 0.008, 40.0);
  EXPECT_NEAR(result.offset.value_s, -0.02, 0.001);
  EXPECT_NEAR(result.applied.time_offset_s, -0.02, 0.001);
  EXPECT_EQ(result.estimate.values[2].name, "lidar.yaw_rad");
  EXPECT_NEAR(result.estimate.values[2].value, 0.008, 0.002);
  EXPECT_NEAR(result.applied.lidar_yaw_rad, 0.008, 0.002);
}

TEST(OnlineCalibrator, FindsNothingOnAPerfectRobot) {
  const Result result = run(0.0, 0.0, 20.0);
  EXPECT_NEAR(result.offset.value_s, 0.0, 0.0005);
  for (const CalibrationValue& value : result.estimate.values) {
    const double nominal = value.name.find("scale") == std::string::npos ? 0.0 : 1.0;
    EXPECT_NEAR(value.value, nominal, 3.0 * value.std) << value.name;
  }
}

TEST(OnlineCalibrator, AppliesNothingBeforeTheEstimateIsCertain) {
  const Result result = run(0.03, 0.0, 0.5);
  EXPECT_DOUBLE_EQ(result.applied.time_offset_s, 0.0);
}

TEST(OnlineCalibrator, NamesItsParametersAsInTheTable) {
  const CalibrationEstimate estimate = run(0.0, 0.0, 0.2).estimate;
  ASSERT_EQ(estimate.values.size(), static_cast<std::size_t>(CalibrationParameter::kGyroXBias));  // then odometry's own
  for (std::size_t i = 0; i < estimate.values.size(); ++i)
    EXPECT_EQ(estimate.values[i].name, kCalibrationParameters[i].name);
}

}  // namespace
}  // namespace patrol::localize::online_calibrator_test
