#include "localize/track_odometry.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "tests/support/tracked_drive.h"

namespace patrol::localize {
namespace {

using test::make_tour;
using test::make_tracked_robot;
using test::stand_then_drive;
using test::TrackedDrive;
using test::TrackedDriveSettings;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Which messages get through at a time.
struct Channels {
  bool imu = true, ticks = true;
};
using Outage = std::function<Channels(double time_s)>;

void run(TrackedDrive& drive, TrackOdometry& odometry, double until_s, const Outage& outage = nullptr) {
  while (to_seconds(drive.now()) < until_s) {
    drive.step();
    const Channels on = outage ? outage(to_seconds(drive.now())) : Channels{};
    if (on.imu) odometry.add(drive.imu());
    if (on.ticks && drive.has_ticks()) odometry.add(drive.ticks());
  }
}

/// Estimate less truth: x, y, yaw. Odom starts where the robot has stood, which is the world's origin.
Eigen::Vector3d planar_error(const TrackOdometry& odometry, const TrackedDrive& drive) {
  const Pose2 estimate = to_planar(odometry.estimate()->T_odom_body), truth = to_planar(drive.T_world_body());
  return {estimate.x - truth.x, estimate.y - truth.y, wrap_angle(estimate.yaw - truth.yaw)};
}

double nees(const TrackOdometry& odometry, const TrackedDrive& drive) {
  const Eigen::Vector3d error = planar_error(odometry, drive);
  return error.dot(odometry.estimate()->planar_covariance.inverse() * error);
}

/// Dead reckoning by the counters alone, as wheeled robots do it: heading by the belts' difference over the gauge.
Pose2 by_counters_alone(const Pose2& before, const TrackTicks& last, const TrackTicks& now, double metres_per_tick, double gauge_m) {
  const double left = metres_per_tick * static_cast<double>(now.left - last.left);
  const double right = metres_per_tick * static_cast<double>(now.right - last.right);
  return before * Pose2{0.5 * (left + right), 0.0, (right - left) / gauge_m};
}

/// Mean of 20 values of chi-square with three degrees of freedom: 95 % lie between these (chi-square of 60, 2.5 % and 97.5 %,
/// over 20).
constexpr double kLowNees = 40.48 / 20.0, kHighNees = 83.30 / 20.0;

TEST(TrackOdometry, NeesOverTwentySeedsLiesWithinItsBoundsAfter30And60And120Seconds) {
  std::array<double, 3> sum{};
  const std::array<double, 3> times{30.0, 60.0, 120.0};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TrackedDrive drive(make_tracked_robot(), make_tour(), {}, seed);
    TrackOdometry odometry(make_tracked_robot(), {});
    for (std::size_t i = 0; i < times.size(); ++i) {
      run(drive, odometry, times[i]);
      sum[i] += nees(odometry, drive);
    }
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_GT(sum[i] / 20.0, kLowNees) << times[i] << " s";
    EXPECT_LT(sum[i] / 20.0, kHighNees) << times[i] << " s";
  }
}

TEST(TrackOdometry, DriftsLessThanAFifthOfCountersAlone) {
  double by_filter = 0.0, by_counters = 0.0, way = 0.0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RobotDescription robot = make_tracked_robot();
    TrackedDrive drive(robot, make_tour(), {}, seed);
    TrackOdometry odometry(robot, {});
    Pose2 alone;
    TrackTicks last = drive.ticks();
    while (to_seconds(drive.now()) < 120.0) {
      run(drive, odometry, to_seconds(drive.now()) + 0.02);
      const TrackTicks ticks = drive.ticks();
      // Even with the mean of the scrub known: what remains is what scrub does from turn to turn.
      alone = by_counters_alone(alone, last, ticks, 2.0 * std::numbers::pi * 0.1 / 720.0, 1.5 * robot.tracks->gauge_m);
      last = ticks;
    }
    by_filter += planar_error(odometry, drive).head<2>().norm();
    by_counters += (alone.position() - drive.T_world_body().position.head<2>()).norm();
    way += drive.way_m();
  }
  std::printf("way %.1f filter %.3f counters %.3f\n", way/5, by_filter/5, by_counters/5);
  EXPECT_LT(by_filter, 0.2 * by_counters);
}

TEST(TrackOdometry, OnIceItsCovarianceGrowsWhileTheBeltsRunOn) {
 for (std::uint64_t seed = 1; seed <= 5; ++seed) {
  TrackedDriveSettings settings;
  settings.friction = [](double time_s) { return time_s > 2.5 && time_s < 9.0 ? 0.0 : 0.8; };
  TrackedDrive drive(make_tracked_robot(), stand_then_drive({0.5, 0.5}), settings, seed);
  TrackOdometry odometry(make_tracked_robot(), {});
  for (double t : {3.5, 4.0, 5.0,7.0, 9.0, 10.0, 12.0, 15.0, 20.0}) {
  run(drive, odometry, t);
  std::printf("ice %lu t %.1f e %.3f sigma %.3f v %.3f true %.3f slip %.3f std v %.3f events %lu lost %d\n", seed, t, planar_error(odometry, drive).x(), std::sqrt(odometry.estimate()->planar_covariance(0,0)), odometry.filter()->motion().v_body.x(), drive.speed_mps(), odometry.filter()->slip(), odometry.twist_std().x(), odometry.health().slip_events, odometry.health().grip_is_lost);
  }
 }
}

TEST(TrackOdometry, Frozen) {
 for (std::uint64_t seed = 1; seed <= 3; ++seed) {
  TrackedDrive drive(make_tracked_robot(), make_tour(), {}, seed);
  TrackOdometry odometry(make_tracked_robot(), {});
  TrackTicks frozen;
  for (double t : {8.0, 8.5, 9.0, 10.0, 12.0, 12.5, 13.0, 14.0, 16.0}) {
  while (to_seconds(drive.now()) < t) {
    drive.step();
    odometry.add(drive.imu());
    if (!drive.has_ticks()) continue;
    TrackTicks ticks = drive.ticks();
    if (to_seconds(drive.now()) > 8.0 && to_seconds(drive.now()) < 12.0) { ticks.left = frozen.left; ticks.right = frozen.right; } else frozen = ticks;
    odometry.add(ticks);
  }
  std::printf("frozen %lu t %.1f e %.3f sigma %.3f v %.3f true %.3f slip %.3f std v %.3f events %lu lost %d silent %d rej %lu\n", seed, t, planar_error(odometry, drive).x(), std::sqrt(odometry.estimate()->planar_covariance(0,0)), odometry.filter()->motion().v_body.x(), drive.speed_mps(), odometry.filter()->slip(), odometry.twist_std().x(), odometry.health().slip_events, odometry.health().grip_is_lost, odometry.health().ticks_are_silent, odometry.health().rejected_messages);
  }
 }
}

}  // namespace
}  // namespace patrol::localize
