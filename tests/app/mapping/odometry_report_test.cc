#include "app/mapping/odometry_report.h"

#include <gtest/gtest.h>

namespace patrol::app::odometry_report_test {
namespace {

using report::Tone;
using slam::OdometryFault;

/// 100 scans, one per second from the stamp 1000 s on.
OdometryReport report_of(const slam::OdometryHealth& health) {
  OdometryReport result{.health = health, .stamps = {}};
  for (int k = 0; k < 100; ++k) result.stamps.push_back(from_seconds(1000.0 + k));
  return result;
}

/// 200 segments of 0.5 m, scales with a standard deviation of 0.002.
slam::OdometryHealth healthy() {
  return {.num_segments = 200,
          .distance_m = 100.0,
          .faulty = {},
          .distance = {{1.004, 0.002}},
          .turn = {{0.99, 0.002}},
          .steering = {{0.0, 0.002}}};
}

TEST(OdometryReport, OfGoodOdometryNamesTheScales) {
  const OdometryReport result = report_of(healthy());
  EXPECT_EQ(
      result.line(),
      "odometry agrees: scale of distance 1.004 ± 0.002, of turn 0.990 ± 0.002, steering 0.000 ± 0.002 rad per m");
  EXPECT_EQ(result.block().tone, Tone::kGood);
  EXPECT_EQ(result.metrics()["distance_scale"]["value"], 1.004);
}

TEST(OdometryReport, WithAScaleOffBy4PercentIsNotCalibrated) {
  slam::OdometryHealth health = healthy();
  health.distance->value = 0.96;
  EXPECT_EQ(report_of(health).block().word, "odometry is not calibrated");
  EXPECT_EQ(report_of(health).block().tone, Tone::kWarning);
}

TEST(OdometryReport, WithoutScalesIsNotChecked) {
  slam::OdometryHealth health = healthy();
  health.distance = health.turn = std::nullopt;
  EXPECT_EQ(report_of(health).block().word, "odometry not checked");
  EXPECT_EQ(report_of(health).block().tone, Tone::kWarning);
}

TEST(OdometryReport, ConstantOverNineTenthsOfTheWayIsMostlyConstant) {
  slam::OdometryHealth health = healthy();
  health.num_faulty = 180;
  health.faulty = {{.fault = OdometryFault::kConstant, .first_scan = 7, .distance_m = 90.0, .p_map = {1.0, 2.0}}};
  health.distance = health.turn = health.steering = std::nullopt;
  const OdometryReport result = report_of(health);
  EXPECT_EQ(result.line(),
            "odometry is mostly constant: 90 % of the segments contradict the map (constant 90 m); scale of distance "
            "not determined, of turn not determined, steering not determined");
  EXPECT_EQ(result.metrics()["faults"][0]["from_s"], 7.0);
  EXPECT_EQ(result.metrics()["faulty_distance"]["constant_m"], 90.0);
  EXPECT_TRUE(result.metrics()["turn_scale"].is_null());
  EXPECT_EQ(result.block().checks.rows.size(), 1U);
}

TEST(OdometryReport, NamesDelayAndGaps) {
  slam::OdometryHealth health = healthy();
  health.delay_s = -0.13;
  health.num_gaps = 3;
  health.max_gap_s = 2.5;
  health.max_gap_scan = 40;
  const std::string line = report_of(health).line();
  EXPECT_EQ(line.substr(0, 36), "odometry has faults: early by 0.13 s");
  EXPECT_NE(line.find("3 gaps between scans, at most 2.5 s, at 40 s"), std::string::npos) << line;
}

TEST(OdometryReport, ByAPathThatIsThatOfOdometryIsNotChecked) {
  slam::OdometryHealth health = healthy();
  health.distance = {{1.0, 5e-16}};
  health.turn = {{1.0 + 6e-13, 2e-12}};
  health.steering = {{8e-12, 1e-12}};
  const OdometryReport result = report_of(health);
  EXPECT_EQ(result.line(), "odometry not checked: the scans determine no motion, the path is that of odometry");
  EXPECT_EQ(result.block().tone, Tone::kWarning);
  EXPECT_TRUE(result.metrics()["distance_scale"].is_null());
  EXPECT_TRUE(result.metrics()["turn_scale"].is_null());
  health.distance->std = 0.001;
  EXPECT_EQ(report_of(health).block().word, "odometry agrees");
}

TEST(OdometryReport, WithAFrozenLidarOverATenthOfTheScansIsNotChecked) {
  OdometryReport result = report_of(healthy());
  result.num_frozen_scans = 10;
  EXPECT_EQ(result.line(), "odometry not checked: the lidar is frozen: 10 of 100 scans repeat the one before");
  result.num_frozen_scans = 5;
  EXPECT_EQ(result.block().word, "odometry agrees");
}

TEST(OdometryReport, WithMoreThanHalfOfTheScansUnmatchedIsNotChecked) {
  OdometryReport result = report_of(healthy());
  result.num_unmatched_scans = 51;
  EXPECT_EQ(result.line(),
            "odometry not checked: 51 of 100 scans matched no surfaces, the path there is that of odometry");
  EXPECT_TRUE(result.metrics()["distance_scale"].is_null());
  result.num_unmatched_scans = 50;
  EXPECT_EQ(result.block().word, "odometry agrees");
}

TEST(OdometryReport, WithoutMotionIsNotChecked) {
  EXPECT_EQ(report_of(slam::OdometryHealth{}).line(),
            "odometry not checked: it hardly moves, and neither does the robot in the map");
}

}  // namespace
}  // namespace patrol::app::odometry_report_test
