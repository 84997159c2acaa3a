#include "slam/graph/scan_tracker.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"
#include "tests/slam/graph/uneven_yard.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::scan_tracker_test {
namespace {

/// Drives a stretch of the corridor, with what odometry makes of each step.
template <typename Odometry>
std::vector<TrackedScan> track(const std::vector<test::DriveStep>& drive, Odometry&& odometry,
                               const test::RoomWorld::ScanOptions& lidar = test::kOldLidar, std::uint64_t seed = 1,
                               const test::RoomWorld& office = test::make_office(),
                               const ScanTrackerSettings& settings = {}) {
  ScanTracker tracker(settings);
  const RandomStream noise(seed, "test/tracker");
  Pose2 T_odom_body;
  std::vector<TrackedScan> tracked;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    if (k > 0) T_odom_body = T_odom_body * odometry(k, drive[k - 1].T_world_body.inverse() * drive[k].T_world_body);
    tracked.push_back(tracker.update(office.scan(drive[k].T_world_body, drive[k].stamp, lidar, noise, k), T_odom_body));
  }
  return tracked;
}

/// The farthest that the estimate is from the truth, both from the start.
double worst_error_m(const std::vector<test::DriveStep>& drive, const std::vector<TrackedScan>& tracked) {
  double worst = 0.0;
  for (std::size_t k = 0; k < drive.size(); ++k) {
    const Pose2 T_start_body = drive[0].T_world_body.inverse() * drive[k].T_world_body;
    worst = std::max(worst, (T_start_body.position() - tracked[k].T_local_body.position()).norm());
  }
  return worst;
}

const std::vector<test::DriveStep>& corridor_drive() {
  static const std::vector<test::DriveStep> drive = test::drive_along({{8.0, 4.2}, {20.0, 4.2}}, {});
  return drive;
}

TEST(ScanTracker, FollowsTwelveMetersToTwoCentimetersWithOdometryThatIsTenPercentTooLong) {
  const auto tracked = track(corridor_drive(), [](std::size_t, const Pose2& motion) {
    return Pose2{1.1 * motion.x, motion.y, motion.yaw + 0.002};
  });
  EXPECT_LT(worst_error_m(corridor_drive(), tracked), 0.02);
}

// Twelve centimeters a scan: wheels that report forwards for backwards, that stand still, that spin.
TEST(ScanTracker, WrongOdometryForTwoMetersCostsNoMoreThanThreeCentimeters) {
  const auto lies = [](std::size_t k) { return k >= 40 && k < 57; };
  for (const double factor : {-1.0, 0.0, 3.0}) {
    const auto tracked = track(corridor_drive(), [&](std::size_t k, const Pose2& motion) {
      return lies(k) ? Pose2{factor * motion.x, 0.0, motion.yaw} : motion;
    });
    EXPECT_LT(worst_error_m(corridor_drive(), tracked), 0.03) << factor;
  }
}

const std::vector<test::DriveStep>& drive_round_corner() {
  static const std::vector<test::DriveStep> drive =
      test::drive_along({{28.0, 4.2}, {39.8, 4.2}, {39.8, 12.0}}, {.turn_radps = 1.0});
  return drive;
}

// The first three scans are 0.12 m apart, and nothing tells yet that the robot moves.
TEST(ScanTracker, OdometryThatIsAlwaysZeroCosts20CentimetersAtTheStartAnd5MoreIn20Meters) {
  const auto& drive = drive_round_corner();
  const auto tracked = track(drive, [](std::size_t, const Pose2&) { return Pose2{}; });
  EXPECT_LT(worst_error_m(drive, tracked), 0.25);
  const Pose2 T_true = drive[10].T_world_body.inverse() * drive.back().T_world_body,
              T_tracked = tracked[10].T_local_body.inverse() * tracked.back().T_local_body;
  EXPECT_THAT(T_tracked, test::Pose2Near(T_true, 0.05, 0.005));
}

// 6 cm a scan, between doors of which a few are in reach.
TEST(ScanTracker, OdometryThatStopsAfterOneMeterIsNotTrustedFor53MetersMoreInACorridorOfDoors) {
  test::RoomWorld::ScanOptions lidar = test::kOldLidar;
  lidar.beams = 90;
  lidar.range_max_m = 5.0;
  const auto drive = test::drive_along({{3.0, 0.0}, {57.0, 0.0}}, {.speed_mps = 0.3});
  const auto tracked = track(
      drive, [](std::size_t k, const Pose2& motion) { return k < 20 ? motion : Pose2{}; }, lidar, 1,
      test::make_corridor_of_doors());
  EXPECT_LT(worst_error_m(drive, tracked), 1.0);
}

// The doors after the gap look like those before it, which are in the map, and odometry is 3 % too long.
TEST(ScanTracker, AfterTenMetersWithoutScansThePoseFollowsOdometryAndNotTheSameDoorsBeforeTheGap) {
  test::RoomWorld::ScanOptions lidar = test::kOldLidar;
  lidar.range_max_m = 5.0;
  std::vector<test::DriveStep> drive = test::drive_along({{3.0, 0.0}, {45.0, 0.0}}, {.speed_mps = 1.0});
  std::erase_if(drive,
                [](const test::DriveStep& step) { return step.T_world_body.x > 20.0 && step.T_world_body.x < 30.0; });
  const auto tracked = track(
      drive,
      [](std::size_t, const Pose2& motion) {
        return Pose2{1.03 * motion.x, motion.y, motion.yaw};
      },
      lidar, 1, test::make_corridor_of_doors());
  EXPECT_LT(worst_error_m(drive, tracked), 0.5);
}

// Every third scan, 0.36 m apart on the way and 34 degrees in the corner.
TEST(ScanTracker, ATurnThatOdometryMissesIsFoundInTheScans) {
  std::vector<test::DriveStep> thinned;
  for (std::size_t k = 0; k < drive_round_corner().size(); k += 3) thinned.push_back(drive_round_corner()[k]);
  const auto tracked = track(thinned, [](std::size_t, const Pose2& motion) { return Pose2{motion.x, motion.y, 0.0}; });
  EXPECT_LT(worst_error_m(thinned, tracked), 0.05);
}

// Stamps of recorded logs jitter: at 20 ms a scan, a turn of 34 degrees would be faster than any robot.
TEST(ScanTracker, ATurnThatOdometryMissesIsFoundEvenIfTheStampsLeaveNoTimeForIt) {
  std::vector<test::DriveStep> thinned;
  for (std::size_t k = 0; k < drive_round_corner().size(); k += 3) {
    thinned.push_back(drive_round_corner()[k]);
    thinned.back().stamp = from_seconds(0.02 * static_cast<double>(thinned.size()));
  }
  const auto tracked = track(thinned, [](std::size_t, const Pose2& motion) { return Pose2{motion.x, motion.y, 0.0}; });
  EXPECT_LT(worst_error_m(thinned, tracked), 0.05);
}

TEST(ScanTracker, With18BeamsOfFiveCentimetersNoiseEachOfTenDrivesIsWithinHalfAMeterAfter20Meters) {
  test::RoomWorld::ScanOptions sparse = test::kOldLidar;
  sparse.beams = 18;
  sparse.range_std_m = 0.05;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto tracked = track(
        drive_round_corner(), [](std::size_t, const Pose2& motion) { return motion; }, sparse, seed);
    EXPECT_LT(worst_error_m(drive_round_corner(), tracked), 0.5) << seed;
  }
}

// Odometry alone would be 1 m and 0.3 rad off.
TEST(ScanTracker, With24BeamsAndWrongOdometryItIsWithin25CentimetersAfter20Meters) {
  test::RoomWorld::ScanOptions sparse = test::kOldLidar;
  sparse.beams = 24;
  const auto tracked = track(
      drive_round_corner(),
      [](std::size_t, const Pose2& motion) {
        return Pose2{1.05 * motion.x, motion.y, motion.yaw + 0.002};
      },
      sparse);
  EXPECT_LT(worst_error_m(drive_round_corner(), tracked), 0.25);
}

TEST(ScanTracker, AKeyframeOfSparseOrGroupedScansHasAllSinceTheLastOne) {
  test::RoomWorld::ScanOptions sparse = test::kOldLidar;
  sparse.beams = 24;
  const auto steps = [](std::size_t, const Pose2& motion) { return motion; };
  const auto scans_of_last_keyframe = [](const std::vector<TrackedScan>& tracked) {
    std::size_t num_scans = 0;
    for (const TrackedScan& scan : tracked) num_scans = scan.is_keyframe ? scan.scans.num_scans() : num_scans;
    return num_scans;
  };
  EXPECT_EQ(scans_of_last_keyframe(track(corridor_drive(), steps, sparse)), 3U);  // 0.12 m a scan, 0.25 m a keyframe
  EXPECT_EQ(scans_of_last_keyframe(track(corridor_drive(), steps)), 1U);
  ScanTrackerSettings grouped;
  grouped.groups_scans = true;
  EXPECT_EQ(scans_of_last_keyframe(track(corridor_drive(), steps, test::kOldLidar, 1, test::make_office(), grouped)),
            3U);
}

// Between smooth walls the scan says nothing of the way: odometry's word stands, and the covariance says how little it
// is.
TEST(ScanTracker, AlongASmoothCorridorOdometryIsUsedAndTheCovarianceIsLarge) {
  test::RoomWorld corridor;
  corridor.add_wall(-100.0, -1.0, 200.0, -1.0).add_wall(-100.0, 1.0, 200.0, 1.0);
  ScanTracker tracker({});
  const RandomStream noise(1, "test/corridor");
  TrackedScan tracked;
  for (std::uint64_t k = 0; k <= 50; ++k) {
    const double x = 0.1 * static_cast<double>(k);
    tracked = tracker.update(
        corridor.scan({x, 0.0, 0.0}, from_seconds(0.2 * static_cast<double>(k)), test::kOldLidar, noise, k),
        {1.03 * x, 0.0, 0.0});
  }
  EXPECT_NEAR(tracked.T_local_body.x, 1.03 * 5.0, 0.05);
  EXPECT_NEAR(tracked.T_local_body.y, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(tracked.covariance(0, 0)), std::hypot(0.005, 0.05 * 0.103), 1e-4);  // odometry's own
  EXPECT_LT(std::sqrt(tracked.covariance(1, 1)), 0.003);
}

// A car waits, drives off at 1.5 m/s when the robot at 0.9 m/s is 4 m behind it, waits 15 m farther on, and so forth.
// It has more points than the posts at the sides, which alone show the way along the street.
TEST(ScanTracker, ACarThatDrivesOffAheadCostsNoMoreThanTenCentimetersIn45Meters) {
  test::RoomWorld street;
  street.add_wall(-50.0, -8.0, 120.0, -8.0).add_wall(-50.0, 6.0, 120.0, 6.0);
  for (int i = -5; i < 12; ++i) street.add_post(10.0 * i, 5.0, 0.15).add_post(10.0 * i + 4.0, -7.0, 0.15);
  ScanTracker tracker({});
  const RandomStream noise(1, "test/street");
  constexpr double kStep_s = 0.1, kSpeed_mps = 0.9, kCarSpeed_mps = 1.5;
  double car_m = 8.0, car_end_m = 8.0, worst_m = 0.0;
  for (std::uint64_t k = 0; k <= 500; ++k) {
    const double x = kSpeed_mps * kStep_s * static_cast<double>(k);
    if (car_m >= car_end_m && car_m - x < 4.0) car_end_m = car_m + 15.0;
    if (car_m < car_end_m) car_m += kCarSpeed_mps * kStep_s;
    test::RoomWorld now = street;
    now.add_box(car_m, -3.6, car_m + 4.5, -1.8);
    const LevelScan scan = now.scan({x, 0.0, 0.0}, from_seconds(kStep_s * static_cast<double>(k)),
                                    {.beams = 1600, .range_std_m = 0.01}, noise, k);
    const TrackedScan tracked = tracker.update(scan, {x, 0.0, 0.0});
    worst_m = std::max(worst_m, (tracked.T_local_body.position() - Eigen::Vector2d(x, 0.0)).norm());
  }
  EXPECT_LT(worst_m, 0.1);
}

// A third of the scans has no beams, in gaps of up to 10 s, and others have ground in front of the robot.
TEST(ScanTracker, OnSlopesWithGroundInTheScansTheErrorIsBelowAThirdOfThatOfOdometry) {
  ScanTrackerSettings settings;
  settings.motion = {.longitudinal_std_m_per_m = 0.03, .lateral_std_m_per_m = 0.02};
  settings.matching.point_angle_std_rad = 0.002;
  settings.keyframe_distance_m = 0.5;
  settings.initial_keyframes = 25;
  for (const std::uint64_t seed : {6U, 11U, 12U}) {
    const test::UnevenYard yard(seed);
    const std::vector<test::DriveStep> drive = test::drive_in_uneven_yard(seed);
    ScanTracker tracker(settings);
    std::vector<TrackedScan> tracked, by_odometry;
    for (std::size_t k = 0; k < drive.size(); ++k) {
      tracked.push_back(tracker.update(yard.scan(drive[k].T_world_body, drive[k].stamp, k), drive[k].T_odom_body));
      by_odometry.push_back({.T_local_body = drive[k].T_odom_body});
    }
    const double error_m = worst_error_m(drive, tracked), odometry_m = worst_error_m(drive, by_odometry);
    EXPECT_LT(error_m, odometry_m / 3.0) << seed;
  }
}

TEST(ScanTracker, KeyframesComeEveryQuarterMeterAndSubmapsEveryThirtyKeyframes) {
  const auto tracked = track(corridor_drive(), [](std::size_t, const Pose2& motion) { return motion; });
  int keyframes = 0, submaps = 0;
  for (const TrackedScan& scan : tracked) {
    keyframes += scan.is_keyframe ? 1 : 0;
    submaps += scan.is_submap_start ? 1 : 0;
    EXPECT_TRUE(scan.is_keyframe || !scan.is_submap_start);
  }
  const double rest_m = 12.0 - 9 * 0.12;          // the first ten scans are all written
  EXPECT_NEAR(keyframes, 10 + rest_m / 0.36, 2);  // a step is 0.12 m, so every third
  EXPECT_EQ(submaps, 2);
}

}  // namespace
}  // namespace patrol::slam::scan_tracker_test
