#include <chrono>
#include <cmath>
#include <deque>
#include <limits>

#include <gtest/gtest.h>

#include "localize/track_odometry.h"
#include "tests/localize/odometry_drive.h"

namespace patrol::localize::track_odometry_faults_test {
namespace {

using test::make_tour;
using test::make_tracked_robot;
using test::stand_then_drive;
using test::TrackedDrive;
using test::TrackedDriveSettings;

TEST(TrackOdometryFaults, OnIceTheBodyStaysWithinThreeSigmaOfItsPosition) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    TrackedDriveSettings settings;
    settings.friction = [](double time_s) { return time_s > 2.5 && time_s < 9.0 ? 0.0 : 0.8; };
    TrackedDrive drive(make_tracked_robot(), stand_then_drive({0.5, 0.5}), settings, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    run(drive, odometry, 2.9);
    const double std_before = std::sqrt(odometry.estimate()->planar_covariance(0, 0));
    run(drive, odometry, 9.0);  // 5.7 s of belts at 0.5 m/s: 2.9 m by the counters
    EXPECT_LT(drive.way_m(), 0.01);
    EXPECT_TRUE(odometry.health().is_slipping);
    const double std = std::sqrt(odometry.estimate()->planar_covariance(0, 0));
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 3.0 * std);
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 0.6);
    EXPECT_GT(std, 0.2 + std_before) << "a map matcher or UWB must be let in";

    run(drive, odometry, 12.0);  // the tracks have taken hold
    EXPECT_FALSE(odometry.health().is_slipping);
    EXPECT_NEAR(odometry.estimate()->twist.linear.x(), drive.speed_mps(), 0.05);
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 3.0 * std);
  }
}

// A push of -6 m/s2 for 0.15 s that is no motion, and shocks of 28 m/s2 after it.
TEST(TrackOdometryFaults, AfterABumpTheCountersAreUsedAgainWithinOneSecond) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TrackedDrive drive(make_tracked_robot(), stand_then_drive({0.6, 0.6}), {}, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    run(drive, odometry, 6.0);
    bool has_slipped = false;
    for (int step = 0; to_seconds(drive.now()) < 7.6; ++step) {
      drive.step();
      Imu imu = drive.imu();
      if (const double time_s = to_seconds(drive.now()); time_s < 6.6)
        imu.linear_acceleration_mps2.x() += time_s < 6.15 ? -6.0 : step / 4 % 2 == 0 ? 28.0 : -28.0;
      odometry.add(imu);
      if (drive.has_ticks()) odometry.add(drive.ticks());
      has_slipped = has_slipped || odometry.health().is_slipping;
    }
    EXPECT_TRUE(has_slipped);
    EXPECT_FALSE(odometry.health().is_slipping);
    run(drive, odometry, 20.0);
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 1.0);
  }
}

TEST(TrackOdometryFaults, CountersFrozenForFourSecondsAreSurvivedAndReported) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TrackedDrive drive(make_tracked_robot(), make_tour(), {}, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    run(drive, odometry, 8.0);
    const TrackTicks frozen = drive.ticks();
    while (to_seconds(drive.now()) < 12.0) {
      drive.step();
      odometry.add(drive.imu());
      if (drive.has_ticks()) odometry.add(TrackTicks{drive.now(), frozen.left, frozen.right});
    }
    EXPECT_TRUE(odometry.health().is_slipping);
    const double std = std::sqrt(odometry.estimate()->planar_covariance(0, 0));
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 3.0 * std);
    run(drive, odometry, 14.0);
    EXPECT_FALSE(odometry.health().is_slipping);
    // Believing them would have lost 4 s at 0.6 m/s: 2.4 m.
    EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 0.5);
  }
}

// The tracks stop from 0.6 m/s, and the accelerometer does not measure it, as when the robot is lifted and put down.
TEST(TrackOdometryFaults, AStopThatTheAccelerometerMissesIsFoundAfterAtMostThreeSecondsAtRest) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    TrackedDrive drive(
        make_tracked_robot(),
        [](double time_s, const Pose3&) {
          return time_s > 2.0 && time_s < 6.0 ? test::Belts{0.6, 0.6} : test::Belts{};
        },
        {}, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    run(drive, odometry, 5.9);
    bool has_slipped = false;
    while (to_seconds(drive.now()) < 9.5) {
      drive.step();
      Imu imu = drive.imu();
      if (to_seconds(drive.now()) < 6.6) imu.linear_acceleration_mps2.x() = 0.0;
      odometry.add(imu);
      if (drive.has_ticks()) odometry.add(drive.ticks());
      has_slipped = has_slipped || odometry.health().is_slipping;
    }
    EXPECT_TRUE(has_slipped);
    EXPECT_FALSE(odometry.health().is_slipping);
    EXPECT_LT(odometry.estimate()->twist.linear.norm(), 0.01);
    const double error_m = std::abs(planar_error(odometry, drive).x());
    EXPECT_LT(error_m, 0.5);
    run(drive, odometry, 14.0);
    EXPECT_NEAR(std::abs(planar_error(odometry, drive).x()), error_m, 0.01);
  }
}

TEST(TrackOdometryFaults, SilentCountersAreReportedAndTheCovarianceGrows) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 5);
  TrackOdometry odometry(make_tracked_robot(), {});
  run(drive, odometry, 8.0);
  const double std_before = std::sqrt(odometry.estimate()->planar_covariance(0, 0));
  run(drive, odometry, 11.0, [](double) { return Channels{.ticks = false}; });
  EXPECT_TRUE(odometry.health().encoders_timed_out);
  const double std = std::sqrt(odometry.estimate()->planar_covariance(0, 0));
  EXPECT_GT(std, 2.0 * std_before);
  EXPECT_LT(std::abs(planar_error(odometry, drive).x()), 3.0 * std);
  run(drive, odometry, 12.0);
  EXPECT_FALSE(odometry.health().encoders_timed_out);
}

TEST(TrackOdometryFaults, TwoSecondsWithoutImuRotateWithTheTracksAndAreReported) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 6);
  TrackOdometry odometry(make_tracked_robot(), {});
  run(drive, odometry, 16.0);
  const double yaw_std_before = std::sqrt(odometry.estimate()->planar_covariance(2, 2));
  run(drive, odometry, 18.0, [](double) { return Channels{.imu = false}; });
  EXPECT_TRUE(odometry.health().imu_timed_out);
  const double yaw_std = std::sqrt(odometry.estimate()->planar_covariance(2, 2));
  EXPECT_GT(yaw_std, 2.0 * yaw_std_before);
  EXPECT_LT(std::abs(planar_error(odometry, drive).z()), 3.0 * yaw_std);
  run(drive, odometry, 19.0);
  EXPECT_FALSE(odometry.health().imu_timed_out);
}

TEST(TrackOdometryFaults, AFrozenImuCountsAsSilent) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 7);
  TrackOdometry odometry(make_tracked_robot(), {});
  run(drive, odometry, 10.0);
  Imu frozen = drive.imu();
  while (to_seconds(drive.now()) < 11.0) {
    drive.step();
    frozen.stamp = drive.now();
    odometry.add(frozen);
    if (drive.has_ticks()) odometry.add(drive.ticks());
  }
  EXPECT_TRUE(odometry.health().imu_timed_out);
  EXPECT_GT(odometry.health().num_rejected_messages, 200U);
}

TEST(TrackOdometryFaults, CountersFortyMillisecondsLateChangeTheEndOfThirtySecondsByLessThanFiveCentimeters) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 8);
  TrackOdometry punctual(make_tracked_robot(), for_plant()), late(make_tracked_robot(), for_plant());
  std::deque<TrackTicks> under_way;
  while (to_seconds(drive.now()) < 30.0) {
    drive.step();
    punctual.add(drive.imu());
    late.add(drive.imu());
    if (!drive.has_ticks()) continue;
    punctual.add(drive.ticks());
    under_way.push_back(drive.ticks());
    if (under_way.size() <= 2) continue;
    late.add(under_way.front());
    under_way.pop_front();
  }
  const Eigen::Vector3d difference = late.estimate()->T_odom_body.position - punctual.estimate()->T_odom_body.position;
  EXPECT_LT(difference.head<2>().norm(), 0.05);
  EXPECT_EQ(late.health().num_slip_events, 0U);
}

TEST(TrackOdometryFaults, RepeatedOldAndBrokenMessagesAreRejectedAndChangeNothing) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 9);
  TrackOdometry clean(make_tracked_robot(), {}), pestered(make_tracked_robot(), {});
  while (to_seconds(drive.now()) < 8.0) {
    drive.step();
    clean.add(drive.imu());
    pestered.add(drive.imu());
    pestered.add(drive.imu());
    Imu broken = drive.imu();
    broken.stamp += std::chrono::milliseconds(1);
    broken.angular_velocity_radps.x() = std::numeric_limits<double>::quiet_NaN();
    pestered.add(broken);
    if (!drive.has_ticks()) continue;
    clean.add(drive.ticks());
    pestered.add(drive.ticks());
    pestered.add(drive.ticks());
  }
  EXPECT_EQ(clean.estimate()->T_odom_body.position, pestered.estimate()->T_odom_body.position);
  EXPECT_EQ(pestered.health().num_rejected_messages, 2U * 2000U + 400U);
}

TEST(TrackOdometryFaults, EncodersThatRestartAtZeroCostNoMeters) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 10);
  TrackOdometry odometry(make_tracked_robot(), {});
  run(drive, odometry, 8.0);
  const TrackTicks at_restart = drive.ticks();
  while (to_seconds(drive.now()) < 12.0) {
    drive.step();
    odometry.add(drive.imu());
    if (!drive.has_ticks()) continue;
    const TrackTicks ticks = drive.ticks();
    odometry.add(TrackTicks{ticks.stamp, ticks.left - at_restart.left, ticks.right - at_restart.right});
  }
  EXPECT_LT(planar_error(odometry, drive).head<2>().norm(), 0.25);
  EXPECT_EQ(odometry.health().num_slip_events, 0U);
}

// The counters restart at 17 s, after a second without the IMU.
TEST(TrackOdometryFaults, CountersThatRestartDuringAnImuOutageDoNotTurnTheRobot) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, 6);
  TrackOdometry clean(make_tracked_robot(), {}), restarted(make_tracked_robot(), {});
  TrackTicks at_restart{};
  while (to_seconds(drive.now()) < 18.0) {
    drive.step();
    const double time_s = to_seconds(drive.now());
    if (time_s < 16.0) {
      clean.add(drive.imu());
      restarted.add(drive.imu());
    }
    if (!drive.has_ticks()) continue;
    const TrackTicks ticks = drive.ticks();
    if (time_s > 17.0 && at_restart.stamp == Time{}) at_restart = ticks;
    clean.add(ticks);
    restarted.add(TrackTicks{ticks.stamp, ticks.left - at_restart.left, ticks.right - at_restart.right});
  }
  const double turned_rad =
      wrap_angle(to_yaw(restarted.estimate()->T_odom_body.rotation) - to_yaw(clean.estimate()->T_odom_body.rotation));
  EXPECT_LT(std::abs(turned_rad), 0.03);
}

}  // namespace
}  // namespace patrol::localize::track_odometry_faults_test
