#include "slam/calibration/calibration.h"

#include <gtest/gtest.h>

#include "tests/slam/calibration/calibration_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::calibration_test {
namespace {

using test::Pose2Near;

constexpr double kExactTol = 1e-12;

TEST(CorrectedStep, AMeterWithSteeringBiasOfATenthIsAnArcOfTenMeters) {
  const Pose2 arc{std::cos(0.05), std::sin(0.05), 0.1};  // a chord of 1 m
  EXPECT_THAT(corrected_step({1.0, 0.0, 0.0}, {.steering_bias_rad_per_m = 0.1}), Pose2Near(arc, kExactTol, kExactTol));
  const Pose2 back{-std::cos(0.05), std::sin(0.05), -0.1};
  EXPECT_THAT(corrected_step({-1.0, 0.0, 0.0}, {.steering_bias_rad_per_m = 0.1}),
              Pose2Near(back, kExactTol, kExactTol));
}

TEST(CorrectedStep, AnArcOfTwiceTheTurnKeepsItsChordAndTurnsItByHalf) {
  const Pose2 step{2.0 * std::cos(0.1), 2.0 * std::sin(0.1), 0.2},
      wanted{3.0 * std::cos(0.2), 3.0 * std::sin(0.2), 0.4};
  EXPECT_THAT(corrected_step(step, {.distance_scale = 1.5, .rotation_scale = 2.0}),
              Pose2Near(wanted, kExactTol, kExactTol));
}

TEST(CorrectedStep, InvertsTheModelOfWornWheels) {
  for (const Pose2& step : {Pose2{0.1, 0.02, 0.3}, Pose2{-0.2, 0.0, -0.1}, Pose2{0.0, 0.0, 0.5}}) {
    EXPECT_THAT(corrected_step(test::reported(step, test::kWorn), test::kWorn), Pose2Near(step, kExactTol, kExactTol));
  }
}

RecordedScan at(const Pose2& T_odom_body) {
  return {.scan = {.ranges_m = {}, .intensities = {}}, .T_odom_body = T_odom_body, .T_body_lidar = {0.1, 0.0, 0.0}};
}

TEST(CalibratedScans, TheDefaultsChangeNothingToTheBit) {
  CalibratedScans scans(Calibration{});
  for (const Pose2& T_odom_body : {Pose2{0.1, 0.7, 3.1}, Pose2{0.3, 0.2, -3.1}}) {
    RecordedScan scan = at(T_odom_body);
    scans.correct(scan);
    EXPECT_EQ(scan.T_odom_body.vector(), T_odom_body.vector());
    EXPECT_EQ(scan.T_body_lidar.x, 0.1);
  }
}

TEST(CalibratedScans, StartAtTheFirstScanAndOverrideTheLidarPose) {
  CalibratedScans scans({.override_lidar_pose = true, .lidar_x_m = 0.3, .distance_scale = 2.0});
  RecordedScan first = at({5.0, 1.0, 0.0}), second = at({6.0, 1.0, 0.0}), third = at({6.0, 2.0, 0.0});
  scans.correct(first);
  scans.correct(second);
  scans.correct(third);
  EXPECT_THAT(first.T_odom_body, Pose2Near(Pose2{5.0, 1.0, 0.0}, 0.0, 0.0));
  EXPECT_THAT(second.T_odom_body, Pose2Near(Pose2{7.0, 1.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(third.T_odom_body, Pose2Near(Pose2{7.0, 3.0, 0.0}, kExactTol, kExactTol));
  EXPECT_EQ(third.T_body_lidar.x, 0.3);
}

TEST(CalibratedScans, TheMotionDuringAScanIsCorrectedToo) {
  CalibratedScans scans({.distance_scale = 2.0, .rotation_scale = 0.5});
  RecordedScan scan = at({});
  scan.T_begin_end = {0.02, 0.0, 0.0};
  scans.correct(scan);
  EXPECT_THAT(scan.T_begin_end, Pose2Near(Pose2{0.04, 0.0, 0.0}, kExactTol, kExactTol));
}

}  // namespace
}  // namespace patrol::slam::calibration_test
