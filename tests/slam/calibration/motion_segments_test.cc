#include "slam/calibration/motion_segments.h"

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "slam/calibration/calibrate.h"
#include "tests/slam/calibration/calibration_world.h"
#include "tests/slam/graph/office_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::motion_segments_test {
namespace {

/// Scan of a lidar in a world of walls.
LaserScan scan_from(const test::RoomWorld& world, const Pose2& T_world_lidar, Time stamp, const RandomStream& noise,
                    std::uint64_t tick) {
  LaserScan scan{.stamp = stamp,
                 .angle_increment_rad = 2.0 * std::numbers::pi / test::kOldLidar.beams,
                 .range_max_m = test::kOldLidar.range_max_m,
                 .ranges_m = {},
                 .intensities = {}};
  for (const double range_m : world.ranges_m(T_world_lidar, test::kOldLidar.beams, test::kOldLidar.range_max_m)) {
    scan.ranges_m.push_back(
        static_cast<float>(range_m + test::kOldLidar.range_std_m * noise.normal(tick, scan.ranges_m.size())));
  }
  return scan;
}

/// The log of a worn robot on its way from corner to corner.
std::vector<RecordedScan> drive(const test::RoomWorld& world, const std::vector<Eigen::Vector2d>& corners,
                                const Calibration& worn, std::uint64_t seed) {
  const RandomStream lidar(seed, "test/lidar"), wheels(seed, "test/wheels");
  std::vector<RecordedScan> log;
  Pose2 T_odom_body, T_world_last;
  for (const test::DriveStep& step : test::drive_along(corners, {})) {
    if (!log.empty()) {
      Pose2 motion = test::reported(T_world_last.inverse() * step.T_world_body, worn);
      const auto normals = wheels.normals(log.size());
      motion.x *= 1.0 + 0.01 * normals[0];
      motion.yaw += 0.01 * motion.yaw * normals[1] + 0.002 * motion.x * normals[2];
      T_odom_body = T_odom_body * motion;
    }
    T_world_last = step.T_world_body;
    log.push_back({.scan = scan_from(world, step.T_world_body * worn.T_body_lidar(), step.stamp, lidar, log.size()),
                   .T_odom_body = T_odom_body,
                   .T_body_lidar = {}});
  }
  return log;
}

std::vector<MotionSegment> pairs_of(const std::vector<RecordedScan>& log, const Calibration& known) {
  MotionSegmenter pairs({}, {}, known);
  for (const RecordedScan& scan : log) pairs.add(scan);
  return pairs.pairs();
}

const std::vector<Eigen::Vector2d> kRound = {{8.0, 4.2},  {20.0, 4.2},  {20.0, 3.9},  {30.0, 4.4},
                                             {39.8, 4.2}, {39.8, 12.0}, {40.0, 25.8}, {30.0, 25.8}};

TEST(MotionSegmenter, StretchesAreHalfAMeterOrAThirdOfARadianAndTheLidarsOwn) {
  const std::vector<RecordedScan> log =
      drive(test::make_office(), {{8.0, 4.2}, {14.0, 4.2}, {14.0, 4.8}}, test::kWorn, 1);
  const std::vector<MotionSegment> pairs = pairs_of(log, {});
  EXPECT_NEAR(static_cast<double>(pairs.size()), 6.0 / 0.6 + 1.57 / 0.36 + 1.0, 2.0);
  for (const MotionSegment& pair : pairs) {
    const Pose2 lidar = pair.lidar();
    EXPECT_GE(std::max({pair.odometry.position().norm() / 0.5, lidar.position().norm() / 0.5,
                        std::abs(pair.odometry.yaw) / 0.35, std::abs(lidar.yaw) / 0.35}),
              1.0);
    EXPECT_LT(pair.begin, pair.end);
  }
  // Straight ahead the lidar, turned by 2 degrees to the left, sees itself move to its right.
  EXPECT_NEAR(std::atan2(pairs[3].lidar().y, pairs[3].lidar().x), to_rad(-2.0), 0.005);
}

// The lidar's own motion from its first beam to its last is not the body's: a quarter of a meter ahead it moves
// sideways while the body turns on the spot.
TEST(MotionSegmenter, LaterBeamsStartAtTheLaterLidarPose) {
  const test::RoomWorld office = test::make_office();
  Calibration worn;
  worn.override_lidar_pose = true;
  worn.lidar_x_m = 0.25;
  const RandomStream none(1, "test/none");
  MotionSegmenter pairs({}, {}, worn);
  constexpr double kTurn = 0.15;  // from scan to scan
  constexpr int kBeams = 360;
  for (int k = 0; k < 60; ++k) {
    const double turn = k % 2 == 0 ? 0.02 : 0.12;  // of it within the scan
    LaserScan scan{.stamp = from_seconds(0.2 * k),
                   .angle_increment_rad = 2.0 * std::numbers::pi / kBeams,
                   .range_max_m = 30.0,
                   .ranges_m = {},
                   .intensities = {}};
    for (std::size_t beam = 0; beam < kBeams; ++beam) {
      const Pose2 T_world_body{12.0, 4.2, kTurn * k + turn * static_cast<double>(beam) / (kBeams - 1)};
      scan.ranges_m.push_back(
          static_cast<float>(office.ranges_m(T_world_body * worn.T_body_lidar(), kBeams, 30.0)[beam]));
    }
    pairs.add({.scan = scan,
               .T_odom_body = {0.0, 0.0, wrap_angle(kTurn * k)},
               .T_body_lidar = {},
               .T_begin_end = {0.0, 0.0, turn}});
  }
  ASSERT_GT(pairs.pairs().size(), 10U);
  for (const MotionSegment& pair : pairs.pairs()) {
    const Pose2 truth = worn.T_body_lidar().inverse() * pair.odometry * worn.T_body_lidar();
    EXPECT_THAT(pair.lidar(), test::Pose2Near(truth, 0.006, 0.003));
  }
}

// The tracker takes odometry's word along the corridor, and the covariance says that the lidar knows nothing of it.
TEST(MotionSegmenter, AlongABareCorridorTheLidarMotionIsUncertain) {
  test::RoomWorld corridor;
  corridor.add_wall(-100.0, -1.0, 200.0, -1.0).add_wall(-100.0, 1.0, 200.0, 1.0);
  const std::vector<MotionSegment> pairs =
      pairs_of(drive(corridor, {{0.0, 0.0}, {12.0, 0.0}}, {.distance_scale = 1.03}, 1), {});
  ASSERT_GT(pairs.size(), 10U);
  for (const MotionSegment& pair : pairs) {
    EXPECT_GT(std::sqrt(pair.lidar_covariance(0, 0)), 0.1);
    EXPECT_LT(std::sqrt(pair.lidar_covariance(1, 1)), 0.01);
  }
  const CalibrationResult result = calibrate(pairs, {}, {.min_segments = 10});
  EXPECT_FALSE(result.parameters[3].is_observable);
  EXPECT_EQ(result.parameters[3].value, 1.0);
}

// From scans to the six numbers, the second pass with what the first found; errors in centimeters and thousandths, and
// in standard deviations: the root mean square of 30 is 1 to about sqrt(1/60) = 0.13 where they are independent, which
// those of one drive are not.
TEST(MotionSegmenter, ADriveThroughAnOfficeCalibratesItsLidarAndWheels) {
  const test::RoomWorld office = test::make_office();
  double sum = 0.0;
  constexpr int kSeeds = 5;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<RecordedScan> log = drive(office, kRound, test::kWorn, seed);
    Calibration found;
    CalibrationResult result;
    for (int pass = 0; pass < 2; ++pass) {
      result = calibrate(pairs_of(log, found), {}, {});
      found = result.calibration();
    }
    EXPECT_NEAR(found.lidar_x_m, test::kWorn.lidar_x_m, 0.01);
    EXPECT_NEAR(found.lidar_y_m, test::kWorn.lidar_y_m, 0.01);
    EXPECT_NEAR(found.lidar_yaw_rad, test::kWorn.lidar_yaw_rad, 0.004);
    EXPECT_NEAR(found.distance_scale, test::kWorn.distance_scale, 0.006);
    EXPECT_NEAR(found.rotation_scale, test::kWorn.rotation_scale, 0.006);
    EXPECT_NEAR(found.steering_bias_rad_per_m, test::kWorn.steering_bias_rad_per_m, 0.002);
    const std::array<double, 6> truth = {test::kWorn.lidar_x_m,      test::kWorn.lidar_y_m,
                                         test::kWorn.lidar_yaw_rad,  test::kWorn.distance_scale,
                                         test::kWorn.rotation_scale, test::kWorn.steering_bias_rad_per_m};
    for (std::size_t i = 0; i < 6; ++i) {
      ASSERT_TRUE(result.parameters[i].is_observable);
      const double error = (result.parameters[i].value - truth[i]) / result.parameters[i].std;
      sum += error * error;
    }
  }
  EXPECT_GT(std::sqrt(sum / (6.0 * kSeeds)), 0.6);
  EXPECT_LT(std::sqrt(sum / (6.0 * kSeeds)), 1.5);
}

}  // namespace
}  // namespace patrol::slam::motion_segments_test
