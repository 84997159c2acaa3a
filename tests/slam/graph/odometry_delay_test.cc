#include "slam/graph/odometry_delay.h"

#include <cmath>
#include <cstdint>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::odometry_delay_test {
namespace {

/// Drive along curves of both signs at 0.5 m/s, with turns of up to 0.6 rad/s that last 3 s.
Pose2 pose_at(double seconds) {
  const double yaw = 0.6 * std::sin(seconds);
  return {0.5 * seconds, 0.1 * std::sin(0.3 * seconds), yaw};
}

struct Log {
  double period_s = 0.2;
  double scan_delay_s = 0.0;       ///< delay of the stamps of the scans
  double tracked_std_rad = 0.001;  ///< standard deviation of the tracked yaw
  double odometry_std_rad = 0.0;   ///< standard deviation of the yaw of odometry, independent from scan to scan
  std::uint64_t seed = 1;
};

/// Called for every scan with the stamp in s, odometry at the stamp, and the returned odometry.
template <typename OnScan>
OdometryDelay play(const Log& log, double duration_s, OnScan&& on_scan) {
  OdometryDelay delay;
  const RandomStream draws(log.seed, "test/odometry_delay");
  for (std::uint64_t scan = 0; static_cast<double>(scan) * log.period_s < duration_s; ++scan) {
    const double seconds = static_cast<double>(scan) * log.period_s;
    Pose2 T_odom_body = pose_at(seconds);
    T_odom_body.yaw = wrap_angle(T_odom_body.yaw + log.odometry_std_rad * draws.normal(scan, 0));
    on_scan(seconds, T_odom_body, delay.compensated(from_seconds(seconds), T_odom_body));
    delay.update(
        wrap_angle(pose_at(seconds - log.scan_delay_s).yaw + 2.0 + log.tracked_std_rad * draws.normal(scan, 1)));
  }
  return delay;
}

OdometryDelay after(const Log& log, double duration_s) {
  return play(log, duration_s, [](double, const Pose2&, const Pose2&) {});
}

TEST(OdometryDelay, ScansStampedLateAreFoundTo20MillisecondsAtAnyRate) {
  for (const double period_s : {0.1, 0.2, 0.3}) {
    for (const double delay_s : {0.08, 0.13, 0.25, 0.38}) {
      EXPECT_NEAR(after({.period_s = period_s, .scan_delay_s = delay_s}, 120.0).scan_delay_s(), delay_s, 0.021)
          << period_s << " " << delay_s;
    }
  }
}

TEST(OdometryDelay, IsNotFoundWithoutTurns) {
  OdometryDelay delay;
  for (int scan = 0; scan < 1000; ++scan) {
    delay.compensated(from_seconds(0.2 * scan), {0.1 * scan, 0.0, 0.0});
    delay.update(0.003 * (scan % 2));
  }
  EXPECT_EQ(delay.scan_delay_s(), 0.0);
}

// Interpolated between two scans, the noise of odometry is smaller. That is no offset.
TEST(OdometryDelay, OdometryAtTheTimeOfTheScansIsUnchangedHoweverNoisyItIs) {
  for (const double odometry_std_rad : {0.0, 0.01, 0.05}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const OdometryDelay delay = play({.odometry_std_rad = odometry_std_rad, .seed = seed}, 300.0,
                                       [](double, const Pose2& T_odom_body, const Pose2& returned) {
                                         ASSERT_EQ(returned.vector(), T_odom_body.vector());
                                       });
      EXPECT_EQ(delay.scan_delay_s(), 0.0);
    }
  }
}

TEST(OdometryDelay, OdometryBehindTheScansIsUnchanged) {
  EXPECT_EQ(after({.scan_delay_s = -0.13}, 60.0).scan_delay_s(), 0.0);
}

TEST(OdometryDelay, IncrementsAreThoseOfTheScansToTwoMillimetersAndNoneJumps) {
  const Log log{.scan_delay_s = 0.14};
  Pose2 before;
  play(log, 60.0, [&](double seconds, const Pose2&, const Pose2& returned) {
    const Pose2 step = before.inverse() * returned;
    const double then = seconds - log.scan_delay_s;
    before = returned;
    if (seconds > 0.0) {
      EXPECT_LT(step.position().norm(), 0.12) << seconds;
    }
    if (seconds > 40.0) {
      EXPECT_THAT(step, test::Pose2Near(pose_at(then - log.period_s).inverse() * pose_at(then), 0.002, 0.004));
    }
  });
}

}  // namespace
}  // namespace patrol::slam::odometry_delay_test
