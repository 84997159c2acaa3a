#include "slam/graph/scan_group.h"

#include <numbers>

#include <gtest/gtest.h>

namespace patrol::slam::scan_group_test {
namespace {

/// A scan of one hit straight ahead.
LevelScan hit_at(float x_m, double stamp_s) {
  return {.stamp = from_seconds(stamp_s), .beams = {{.end_m = {x_m, 0.0F}, .is_hit = true}}};
}

TEST(ScanGroup, ItsFrameIsThatOfTheNewestScan) {
  ScanGroup group(hit_at(2.0F, 1.0));
  group.add(hit_at(3.0F, 1.5), {0.5, 0.0, std::numbers::pi / 2});
  EXPECT_EQ(group.num_scans(), 2U);
  EXPECT_EQ(group.stamp(), from_seconds(1.5));
  const std::vector<MatchPoint> points = group.match_points(0.08, 100);
  ASSERT_EQ(points.size(), 2U);
  // The older hit lies 1.5 m ahead of the turn, on the right after it.
  EXPECT_NEAR(points[0].p_body.x(), 0.0, 1e-6);
  EXPECT_NEAR(points[0].p_body.y(), -1.5, 1e-6);
  EXPECT_NEAR(points[1].p_body.x(), 3.0, 1e-6);
  EXPECT_NEAR(points[1].p_body.y(), 0.0, 1e-6);
}

TEST(ScanGroup, AReplacedScanLeavesTheOthersWhereTheyAre) {
  ScanGroup group(hit_at(2.0F, 1.0));
  group.add(hit_at(9.0F, 1.1), {0.3, 0.0, 0.0});
  group.replace_newest(hit_at(4.0F, 1.2), {0.2, 0.0, 0.0});
  ASSERT_EQ(group.num_scans(), 2U);
  const std::vector<MatchPoint> points = group.match_points(0.08, 100);
  EXPECT_NEAR(points[0].p_body.x(), 1.5, 1e-6);
  EXPECT_NEAR(points[1].p_body.x(), 4.0, 1e-6);
}

TEST(ScanGroup, ItsScansAreGivenInItsFrameAndMakeTheSameGroup) {
  ScanGroup group(hit_at(2.0F, 1.0));
  group.add(hit_at(3.0F, 1.5), {0.5, 0.0, std::numbers::pi / 2});
  const std::vector<LevelScan> scans = group.scans();
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_NEAR(scans[0].origin_m.y(), 0.5, 1e-6);  // half a meter behind, before the turn to the left
  EXPECT_NEAR(scans[0].beams[0].end_m.y(), -1.5F, 1e-6F);
  EXPECT_EQ(scans[1].origin_m, Eigen::Vector2d::Zero());
  const ScanGroup same(scans);
  EXPECT_EQ(same.num_scans(), 2U);
  EXPECT_EQ(same.stamp(), from_seconds(1.5));
  EXPECT_NEAR(same.match_points(0.08, 100)[0].p_body.y(), -1.5, 1e-6);
}

TEST(ScanGroup, ItsScansAreMappedAtTheirOwnPoses) {
  ScanGroup group(hit_at(2.0F, 1.0));
  LevelScan aside = hit_at(0.0F, 1.5);
  aside.beams[0].end_m = {0.0F, 3.0F};
  group.add(aside, {0.5, 0.0, 0.0});
  GridMap map(0.05, 100.0);
  const Pose2 T_map_group{10.02, 5.02, 0.0};
  group.integrate(T_map_group, {}, map);
  EXPECT_TRUE(map.is_surface(map.cell_at({11.52, 5.02})));
  EXPECT_TRUE(map.is_surface(map.cell_at({10.02, 8.02})));
}

}  // namespace
}  // namespace patrol::slam::scan_group_test
