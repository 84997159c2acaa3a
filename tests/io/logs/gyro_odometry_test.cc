#include "io/logs/gyro_odometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::io::gyro_odometry_test {
namespace {

using namespace std::chrono_literals;

constexpr double kBias = 0.02;

struct Drive {
  double slope = 1.0;  ///< odometry's turn over the true one
  double gyro_factor = 1.0;
  double stationary_s = 5.0;  ///< at the start
  bool has_gap = false;       ///< whether the gyro has a gap from 20 s to 22 s
};

/// 60 s at 0.5 m/s, turning by 0.5 sin(t) rad/s: the gyro 100 times a second, a scan every 0.2 s. Gives what is made of
/// the last scan, and the truth.
struct Driven {
  GyroOdometry gyro;
  Pose2 T_odom, T_fused, T_true;
};
Driven drive(const Drive& how) {
  Driven driven;
  for (int tick = 0; tick <= 6000; ++tick) {
    const Time now = tick * 10ms;
    const double t = to_seconds(now) - how.stationary_s, rate = t > 0.0 ? 0.5 * std::sin(t) : 0.0;
    if (!how.has_gap || now <= 20s || now >= 22s) driven.gyro.add(now, how.gyro_factor * rate + kBias);
    const double turn = t > 0.0 ? 0.01 * 0.5 * std::sin(t - 0.005) : 0.0, way = t > 0.0 ? 0.005 : 0.0;
    if (tick > 0) {
      driven.T_true = driven.T_true * Pose2{way * std::cos(0.5 * turn), way * std::sin(0.5 * turn), turn};
      driven.T_odom = driven.T_odom * Pose2{way * std::cos(0.5 * how.slope * turn),
                                            way * std::sin(0.5 * how.slope * turn), how.slope * turn};
    }
    if (tick % 20 == 0) driven.T_fused = driven.gyro.fuse(now, driven.T_odom);
  }
  return driven;
}

// The chord of a step of 0.1 m that odometry turns by 0.12 rad instead of 0.1 is 0.1 * (0.12^2 - 0.1^2) / 24 = 0.018 mm
// too short: 5 mm in 275 steps.
TEST(GyroOdometry, RotatesByTheGyroWithoutTheBiasMeasuredAtRest) {
  const Driven driven = drive({.slope = 1.2});
  EXPECT_GT((driven.T_odom.position() - driven.T_true.position()).norm(), 0.5);
  EXPECT_THAT(driven.T_fused, test::Pose2Near(driven.T_true, 0.005, 1e-3));
  EXPECT_NEAR(driven.gyro.bias_radps().value(), kBias, 1e-4);
  EXPECT_NEAR(driven.gyro.stationary_s(), 5.0, 0.21);
  EXPECT_EQ(driven.gyro.uncovered_s(), 0.0);
  EXPECT_EQ(driven.gyro.motion_without_bias_s(), 0.0);
}

TEST(GyroOdometry, WithoutRestZeroBiasIsAssumedAndReported) {
  const Driven driven = drive({.slope = 1.2, .stationary_s = 0.0});
  EXPECT_FALSE(driven.gyro.bias_radps());
  EXPECT_NEAR(wrap_angle(driven.T_fused.yaw - driven.T_true.yaw - 60.0 * kBias), 0.0, 0.01);
  EXPECT_NEAR(driven.gyro.motion_without_bias_s(), 60.0, 0.5);
}

TEST(GyroOdometry, AnEarlierBiasIsUsedUntilTheRobotIsAtRest) {
  GyroOdometry gyro(0.3);
  for (int tick = 0; tick <= 100; ++tick) gyro.add(tick * 100ms, tick < 40 ? 0.5 : 0.02);
  gyro.fuse(0s, {});
  EXPECT_NEAR(gyro.fuse(2s, {1.0, 0.0, 0.0}).yaw, 2.0 * (0.5 - 0.3), 1e-12);
  gyro.fuse(4s, {2.0, 0.0, 0.0});
  for (int second = 5; second <= 9; ++second) gyro.fuse(second * 1s, {2.0, 0.0, 0.0});
  EXPECT_NEAR(gyro.bias_radps().value(), 0.02, 1e-9);
  EXPECT_EQ(gyro.motion_without_bias_s(), 0.0);
}

TEST(GyroOdometry, WithoutGyroReadingsOdometryRotates) {
  const Driven driven = drive({.slope = 1.0, .has_gap = true});
  EXPECT_THAT(driven.T_fused, test::Pose2Near(driven.T_true, 0.003, 1e-3));
  EXPECT_NEAR(driven.gyro.uncovered_s(), 2.0, 0.41);
}

TEST(GyroOdometry, DistinguishesAgreementContradictionAndNoCorrelation) {
  EXPECT_EQ(GyroOdometry().consistency(), GyroConsistency::kUnknown);
  EXPECT_EQ(drive({.slope = 1.005}).gyro.consistency(), GyroConsistency::kAgrees) << "the bias does not matter";
  EXPECT_EQ(drive({.slope = 1.1}).gyro.consistency(), GyroConsistency::kContradicts);
  EXPECT_EQ(drive({.slope = 0.9}).gyro.consistency(), GyroConsistency::kContradicts);
  EXPECT_EQ(drive({.gyro_factor = -1.0}).gyro.consistency(), GyroConsistency::kUnrelated) << "hangs upside down";
  EXPECT_EQ(drive({.gyro_factor = 0.0}).gyro.consistency(), GyroConsistency::kUnknown) << "another axis";
}

TEST(GyroOdometry, RotatesWithinAScanToo) {
  GyroOdometry gyro(0.1);
  for (int tick = 0; tick <= 10; ++tick) gyro.add(tick * 10ms, 1.1);
  const Pose2 replace_rotation = gyro.replace_rotation({0.05, 0.0, 0.0}, 20ms, 70ms);
  EXPECT_THAT(replace_rotation,
              test::Pose2Near(Pose2{0.05 * std::cos(0.025), 0.05 * std::sin(0.025), 0.05}, 1e-12, 1e-12));
  EXPECT_THAT(gyro.replace_rotation({0.05, 0.0, 0.01}, 70ms, 120ms), test::Pose2Near(Pose2{0.05, 0.0, 0.01}, 0.0, 0.0))
      << "not covered";
}

TEST(GyroOdometry, StampsThatDoNotGrowAreDropped) {
  GyroOdometry gyro;
  gyro.add(0s, 1.0);
  gyro.add(200ms, 1.0);
  gyro.add(100ms, 50.0);
  gyro.add(400ms, 1.0);
  gyro.fuse(0s, {});
  EXPECT_NEAR(gyro.fuse(400ms, {0.4, 0.0, 0.0}).yaw, 0.4, 1e-12);
}

}  // namespace
}  // namespace patrol::io::gyro_odometry_test
