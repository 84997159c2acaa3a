#include "score/water_score.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::score::water_score_test {
namespace {

const Eigen::Vector3d kAntenna(0.0, 0.0, 1.0);
const std::vector<WaterGroundTruth> kBody = {{.p_world_m = {20.0, 0.0, 1.5}, .radius_m = 6.0}};

/// Stands at the origin of world from 0 to 10 s, half a metre up.
Trajectory standing() {
  const Pose3 T_world_body = to_pose3({}, 0.5);
  return {{from_seconds(0.0), T_world_body}, {from_seconds(10.0), T_world_body}};
}

WaterResult found_at(const Eigen::Vector3d& p_map) {
  WaterResult result;
  result.stamp = from_seconds(5.0);
  result.station = "face";
  result.soundings = 35;
  result.is_found = true;
  result.p_map = p_map;
  result.covariance_m2 = Eigen::Vector3d(1.0, 0.25, 0.25).asDiagonal();
  result.distance_low_m = 19.0, result.distance_high_m = 22.0;
  result.radius_m = 5.5, result.radius_low_m = 5.0, result.radius_high_m = 5.9;
  return result;
}

TEST(WaterScore, ABodyReportedOneMetreTooFarIsFoundWithThatError) {
  const WaterScore score = water_score({found_at({21.0, 0.0, 1.0})}, kBody, {}, standing(), kAntenna);
  EXPECT_EQ(score.stations, 1);
  EXPECT_EQ(score.found, 1);
  EXPECT_EQ(score.missed, 0);
  EXPECT_EQ(score.false_alarms, 0);
  ASSERT_EQ(score.findings.size(), 1U);
  const WaterFinding& finding = score.findings[0];
  EXPECT_NEAR(finding.position_error_m, 1.0, 1e-12);
  EXPECT_NEAR(finding.ahead_error_m, 1.0, 1e-12);
  EXPECT_NEAR(finding.radius_error_m, -0.5, 1e-12);
  EXPECT_TRUE(finding.distance_in_interval);   // 20 m in 19 ... 22
  EXPECT_FALSE(finding.radius_in_interval);    // 6 m in 5.0 ... 5.9
  EXPECT_TRUE(finding.position_in_ellipsoid);  // 1 / 1 < 7.8
}

TEST(WaterScore, AnErrorOfTwoMetresAcrossLeavesTheEllipsoidOfHalfAMetre) {
  const WaterFinding finding =
      water_score({found_at({20.0, 2.0, 1.0})}, kBody, {}, standing(), kAntenna).findings.at(0);
  EXPECT_NEAR(finding.position_error_m, 2.0, 1e-12);
  EXPECT_NEAR(finding.ahead_error_m, 0.0, 1e-12);
  EXPECT_FALSE(finding.position_in_ellipsoid);  // 4 / 0.25 = 16 > 7.8
}

TEST(WaterScore, TheMapsFrameTurnsPositionAndCovariance) {
  const Pose2 T_world_map{0.0, 0.0, std::numbers::pi / 2.0};  // x of map is y of world
  const std::vector<WaterGroundTruth> body = {{.p_world_m = {0.0, 20.0, 1.5}, .radius_m = 6.0}};
  const WaterFinding finding =
      water_score({found_at({22.0, 0.0, 1.0})}, body, T_world_map, standing(), kAntenna).findings.at(0);
  EXPECT_NEAR(finding.ahead_error_m, 2.0, 1e-12);
  EXPECT_TRUE(finding.position_in_ellipsoid);  // 4 / 1: along x of map the interval is wide
}

TEST(WaterScore, ABodySevenMetresAsideIsMissedAndTheFindingFalse) {
  const WaterScore score = water_score({found_at({20.0, 7.0, 1.0})}, kBody, {}, standing(), kAntenna);
  EXPECT_EQ(score.found, 0);
  EXPECT_EQ(score.missed, 1);
  EXPECT_EQ(score.false_alarms, 1);
}

TEST(WaterScore, SoundingsThatFindNothingMissTheBodyAndNoSoundingsMissNothing) {
  WaterResult nothing = found_at({20.0, 0.0, 1.0});
  nothing.is_found = false;
  EXPECT_EQ(water_score({nothing}, kBody, {}, standing(), kAntenna).missed, 1);
  EXPECT_EQ(water_score({nothing}, {}, {}, standing(), kAntenna).false_alarms, 0);
  EXPECT_EQ(water_score({}, kBody, {}, standing(), kAntenna).missed, 0);
}

}  // namespace
}  // namespace patrol::score::water_score_test
