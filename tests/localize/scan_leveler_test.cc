#include "localize/scan_leveler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/trajectory.h"
#include "tests/support/walking_robot.h"

namespace patrol::localize::scan_leveler_test {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr float kInf = std::numeric_limits<float>::infinity();
const Pose3 kLidar{{-0.02, 0.0, 0.175}, Eigen::Quaterniond::Identity()};

/// A room 12 m x 8 m around the origin with its floor at `floor_z_m`; the distance along a ray from inside.
double range_in_room(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double floor_z_m) {
  double range = std::numeric_limits<double>::infinity();
  const auto meet = [&](double distance, double speed) {
    if (speed > 0.0) range = std::min(range, distance / speed);
  };
  meet(6.0 - from.x(), direction.x());
  meet(6.0 + from.x(), -direction.x());
  meet(4.0 - from.y(), direction.y());
  meet(4.0 + from.y(), -direction.y());
  meet(from.z() - floor_z_m, -direction.z());
  return range;
}

/// Body pose in odom: walks at 1 m/s, turns at 1 rad/s, pitches by 3 degrees at 5.5 Hz and rolls by 2 degrees
/// at 2.8 Hz.
Pose3 wobbling(Time stamp) {
  const double t = to_seconds(stamp);
  return {{t - 0.5, 0.2 * t, 0.0}, quaternion_from_rpy(0.035 * std::sin(17.5 * t), 0.052 * std::sin(35.0 * t), t)};
}

LaserScan scan_room(const PoseLookup& T_odom_body_at, Time start, int beams, double floor_z_m) {
  LaserScan scan{.stamp = start,
                 .angle_min_rad = -std::numbers::pi,
                 .angle_increment_rad = kTwoPi / beams,
                 .time_increment_s = 0.1 / beams,
                 .scan_time_s = 0.1,
                 .range_min_m = 0.05,
                 .range_max_m = 30.0,
                 .ranges_m = {},
                 .intensities = {}};
  for (int beam = 0; beam < beams; ++beam) {
    const Pose3 T_odom_lidar = *T_odom_body_at(start + from_seconds(beam * scan.time_increment_s)) * kLidar;
    const double azimuth = scan.angle_min_rad + beam * scan.angle_increment_rad;
    const Eigen::Vector3d direction =
        T_odom_lidar.rotation * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
    scan.ranges_m.push_back(static_cast<float>(range_in_room(T_odom_lidar.position, direction, floor_z_m)));
  }
  return scan;
}

/// Distance of a point in odom to the nearest wall.
double distance_to_wall(const Eigen::Vector2d& p) {
  return std::min(std::abs(6.0 - std::abs(p.x())), std::abs(4.0 - std::abs(p.y())));
}

double worst_wall_error(const LevelScan& level) {
  const Pose2 T_odom_level = to_pose2(wobbling(level.stamp));
  double worst = 0.0;
  for (const LevelScan::Beam& beam : level.beams) {
    if (beam.is_hit) worst = std::max(worst, distance_to_wall(T_odom_level * beam.end_m.cast<double>()));
  }
  return worst;
}

TEST(ScanLeveler, WallsOfARoomAreExactToAMillimeterWhileWalkingAndTurning) {
  const ScanLeveler leveler(kLidar, {});
  for (const double start_s : {0.0, 0.13, 0.29}) {
    const LaserScan scan = scan_room(wobbling, from_seconds(start_s), 3200, -10.0);
    const auto level = leveler.level(scan, PoseLookup(wobbling), 0.3);
    ASSERT_TRUE(level);
    EXPECT_GT(std::count_if(level->beams.begin(), level->beams.end(), [](const auto& beam) { return beam.is_hit; }),
              2500);
    EXPECT_LT(worst_wall_error(*level), 0.001);
  }
}

TEST(ScanLeveler, WithoutTheMotionTheSameWallsAreHalfAMeterOff) {
  const ScanLeveler leveler(kLidar, {});
  const LaserScan scan = scan_room(wobbling, Time{0}, 3200, -10.0);
  const Time end = scan.stamp + from_seconds(3199 * scan.time_increment_s);
  const auto frozen = leveler.level(
      scan, [end](Time) { return wobbling(end); }, 0.3);
  EXPECT_GT(worst_wall_error(*frozen), 0.3);
}

TEST(ScanLeveler, ScansOfAStabilizedLidarAreExactWithTheSetting) {
  // What a lidar on a gimbal sees: from where the wobbling body carries it, but level.
  const auto level_lidar = [](Time stamp) {
    return std::optional(remove_tilt(wobbling(stamp) * kLidar) * kLidar.inverse());
  };
  const LaserScan scan = scan_room(level_lidar, Time{0}, 3200, -10.0);
  EXPECT_LT(worst_wall_error(*ScanLeveler(kLidar, {.gimbal_stabilized = true}).level(scan, PoseLookup(wobbling), 0.3)),
            0.001);
  EXPECT_GT(worst_wall_error(*ScanLeveler(kLidar, {}).level(scan, PoseLookup(wobbling), 0.3)), 0.001);
}

TEST(ScanLeveler, StampIsThatOfTheLastBeamAndOriginIsTheLidarThen) {
  const LaserScan scan = scan_room(wobbling, Time{0}, 1000, -10.0);
  const auto level = ScanLeveler(kLidar, {}).level(scan, PoseLookup(wobbling), 0.3);
  EXPECT_EQ(level->stamp, from_seconds(0.0999));
  // -0.02 m behind, and 0.175 m up a trunk pitched by 0.052 sin(3.4965) = -0.0181 rad: -0.02 - 0.0032.
  EXPECT_NEAR(level->origin_m.x(), -0.02 + 0.175 * std::sin(0.052 * std::sin(35.0 * 0.0999)), 1e-4);
}

TEST(ScanLeveler, GroundInFrontOfATippedRobotIsNoObstacleAndFreeUpToTheBand) {
  // 5 degrees nose down, lidar 0.475 m above the ground: the front beam meets the ground 5.4 m ahead, and
  // sinks below 0.15 m (margin off) at 0.325 / tan(5 deg) = 3.7 m.
  const double pitch = to_rad(5.0);
  const PoseLookup tipped = [=](Time) { return Pose3{{0, 0, 0}, quaternion_from_rpy(0, pitch, 0)}; };
  const LaserScan scan = scan_room(tipped, Time{0}, 720, -0.3);
  const auto level = ScanLeveler(kLidar, {.tilt_margin_rad = 0.0}).level(scan, tipped, 0.3);
  ASSERT_TRUE(level);
  const auto front = std::min_element(level->beams.begin(), level->beams.end(), [](const auto& a, const auto& b) {
    return std::abs(std::atan2(a.end_m.y(), a.end_m.x())) < std::abs(std::atan2(b.end_m.y(), b.end_m.x()));
  });
  EXPECT_FALSE(front->is_hit);
  const double lidar_x = 0.175 * std::sin(pitch) - 0.02 * std::cos(pitch);
  const double lidar_z = 0.3 + 0.175 * std::cos(pitch) + 0.02 * std::sin(pitch);
  EXPECT_NEAR(front->end_m.x(), lidar_x + (lidar_z - 0.15) / std::tan(pitch), 1e-3);
  for (const auto& beam : level->beams) {
    if (!beam.is_hit) continue;
    EXPECT_LT(distance_to_wall(beam.end_m.cast<double>()), 1e-3);
  }
}

TEST(ScanLeveler, KerbOfTwelveCentimetersIsNoObstacleAndAWallOfTwentyIs) {
  const double pitch = 0.1;
  const PoseLookup tipped = [=](Time) { return Pose3{{0, 0, 0}, quaternion_from_rpy(0, pitch, 0)}; };
  const auto level_hit_at_height = [&](double height_m) {
    const Eigen::Vector3d lidar = quaternion_from_rpy(0, pitch, 0) * kLidar.position;
    const double range = (0.3 + lidar.z() - height_m) / std::sin(pitch);
    const LaserScan scan{.time_increment_s = 1e-4, .ranges_m = {static_cast<float>(range)}, .intensities = {}};
    return ScanLeveler(kLidar, {.tilt_margin_rad = 0.005}).level(scan, tipped, 0.3)->beams.at(0).is_hit;
  };
  EXPECT_FALSE(level_hit_at_height(0.12));
  EXPECT_TRUE(level_hit_at_height(0.20));
}

TEST(ScanLeveler, BeamThatClimbsAboveTheBandIsFreeUpToThere) {
  const PoseLookup reared = [](Time) { return Pose3{{0, 0, 0}, quaternion_from_rpy(0, -0.2, 0)}; };
  const LaserScan scan{.time_increment_s = 1e-4, .ranges_m = {20.0F}, .intensities = {}};
  const auto level = ScanLeveler(kLidar, {}).level(scan, reared, 0.3);
  const Eigen::Vector3d lidar = quaternion_from_rpy(0, -0.2, 0) * kLidar.position;
  EXPECT_FALSE(level->beams.at(0).is_hit);
  EXPECT_NEAR(level->beams.at(0).end_m.x(), lidar.x() + (1.5 - 0.3 - lidar.z()) / std::tan(0.2), 1e-4);
}

TEST(ScanLeveler, ReportsATiltOf12DegreesInAnyDirection) {
  const LaserScan scan{.time_increment_s = 1e-4, .ranges_m = {1.0F, 2.0F}, .intensities = {}};
  for (const double heading : {0.0, 2.0}) {
    const PoseLookup on_a_ramp = [=](Time) {
      return Pose3{{1.0, 2.0, 0.5}, quaternion_from_rpy(0.12, -0.173, heading)};
    };
    const double tilt = std::acos(std::cos(0.12) * std::cos(0.173));
    EXPECT_NEAR(ScanLeveler(kLidar, {}).level(scan, on_a_ramp, 0.3)->tilt_rad, tilt, 1e-9);
  }
}

TEST(ScanLeveler, AnUpsideDownLidarIsLevelAndItsBeamsEndWhereThoseOfAnUprightOneDo) {
  const double roll = 0.05;
  const PoseLookup tilted = [=](Time) { return Pose3{{0, 0, 0}, quaternion_from_rpy(roll, 0.0, 0.3)}; };
  const Pose3 flipped{kLidar.position, kLidar.rotation * quaternion_from_rpy(std::numbers::pi, 0.0, 0.0)};
  LaserScan upright{.angle_min_rad = -1.0, .angle_increment_rad = 0.5, .ranges_m = {}, .intensities = {}};
  upright.ranges_m = {1.0F, 2.0F, 1.5F, 3.0F, 2.5F};
  LaserScan mirrored = upright;
  std::ranges::reverse(mirrored.ranges_m);
  for (const bool is_stabilized : {false, true}) {
    const ScanLevelerSettings settings{.min_height_m = -1.0, .gimbal_stabilized = is_stabilized};
    const auto expected = ScanLeveler(kLidar, settings).level(upright, tilted, 0.3);
    const auto level = ScanLeveler(flipped, settings).level(mirrored, tilted, 0.3);
    EXPECT_NEAR(level->tilt_rad, is_stabilized ? 0.0 : roll, 1e-7);
    ASSERT_EQ(level->beams.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_LT((level->beams[i].end_m - expected->beams[4 - i].end_m).norm(), 1e-5F);
      EXPECT_TRUE(level->beams[i].is_hit);
    }
  }
}

TEST(ScanLeveler, RangesFollowRep117) {
  const PoseLookup still = [](Time) { return Pose3{}; };
  const LaserScan scan{.angle_increment_rad = 0.1,
                       .time_increment_s = 1e-4,
                       .ranges_m = {kInf, -kInf, std::numeric_limits<float>::quiet_NaN(), 3.0F, 0.1F},
                       .intensities = {}};
  const auto level = ScanLeveler(kLidar, {.no_return_clearing_range_m = 7.0}).level(scan, still, 0.3);
  ASSERT_TRUE(level);
  ASSERT_EQ(level->beams.size(),
            2U);  // no return: free; too close, invalid: nothing; 3 m: hit; 0.1 m: the robot itself
  EXPECT_FALSE(level->beams[0].is_hit);
  EXPECT_NEAR(level->beams[0].end_m.x(), 7.0 - 0.02, 1e-6);
  EXPECT_TRUE(level->beams[1].is_hit);
  EXPECT_NEAR((level->beams[1].end_m - Eigen::Vector2f(-0.02F, 0.0F)).norm(), 3.0, 1e-5);
}

TEST(ScanLeveler, NoAnswerWithoutBeamsOrWithoutPosesForAllOfThem) {
  const ScanLeveler leveler(kLidar, {});
  EXPECT_FALSE(leveler.level(LaserScan{}, PoseLookup(wobbling), 0.3));
  const LaserScan scan = scan_room(wobbling, Time{0}, 100, -10.0);
  const PoseLookup late_start = [](Time t) {
    return t < from_seconds(0.05) ? std::nullopt : std::optional(wobbling(t));
  };
  EXPECT_FALSE(leveler.level(scan, late_start, 0.3));
  const PoseLookup early_end = [](Time t) {
    return t > from_seconds(0.05) ? std::nullopt : std::optional(wobbling(t));
  };
  EXPECT_FALSE(leveler.level(scan, early_end, 0.3));
}

TEST(ScanLeveler, ScansWithFewerBeamsThanKnotsKeepEveryBeam) {
  const PoseLookup still = [](Time) { return Pose3{}; };
  for (const int beams : {1, 2, 5, 33, 34, 100}) {
    const LaserScan scan = scan_room(still, Time{0}, beams, -10.0);
    EXPECT_EQ(ScanLeveler(kLidar, {}).level(scan, still, 0.3)->beams.size(), static_cast<std::size_t>(beams));
  }
}

TEST(ScanLeveler, WithTheEstimatorInTheLoopWallsAreAsGoodAsItsPose) {
  const RobotDescription quadruped = test::make_quadruped();
  test::WalkingRobot robot(quadruped, test::stand_then_walk(1.0, {.vx_mps = 0.4, .yaw_rate_radps = 0.8}),
                           test::WalkingRobotSettings::without_noise(), 1);
  LeggedOdometry odometry(quadruped, {});
  Trajectory truth;
  while (to_seconds(robot.now()) < 5.0) {
    robot.step();
    odometry.add(robot.imu());
    odometry.add(robot.joints());
    odometry.add(robot.contacts());
    truth.push_back({robot.now(), robot.T_world_body()});
  }
  const Time start = from_seconds(4.9) - from_seconds(0.004);
  const LaserScan scan = scan_room([&](Time t) { return pose_at(truth, t); }, start, 1600, 0.0);
  const auto level = ScanLeveler(kLidar, {}).level(scan, odometry);
  ASSERT_TRUE(level);
  const Pose2 T_world_level = to_pose2(*pose_at(truth, level->stamp));
  for (const auto& beam : level->beams) {
    if (!beam.is_hit) continue;
    EXPECT_LT(distance_to_wall(T_world_level * beam.end_m.cast<double>()), 0.02);
  }
}

}  // namespace
}  // namespace patrol::localize::scan_leveler_test
