#include "slam/scan_integration.h"

#include <gtest/gtest.h>

namespace patrol::slam::scan_integration_test {
namespace {

// One beam along +x from the middle of cell (0, 0), cells of 10 cm: what each cell of row 0 has learnt.
GridMap map_after(double range_m, bool is_hit, const ScanIntegrationSettings& settings) {
  GridMap map(0.1, 100.0);
  LevelScan scan;
  scan.beams.push_back({Eigen::Vector2f(static_cast<float>(range_m), 0.0F), is_hit});
  integrate_scan(scan, {0.05, 0.05, 0.0}, settings, map);
  return map;
}

int passes_of(const GridMap& map, int col) {
  const std::optional<GridCell> cell = map.find({col, 0});
  return cell ? cell->passes : 0;
}

TEST(IntegrateScan, AHitInCellTenClearsItsRayLessTheMargin) {
  const GridMap map = map_after(0.98, true, {.free_ray_stride = 1, .free_margin_m = 0.15});
  EXPECT_TRUE(map.is_surface({10, 0}));
  EXPECT_EQ(passes_of(map, 0), 1);
  EXPECT_EQ(passes_of(map, 8), 1);  // free to x = 0.05 + 0.98 - 0.15 = 0.88
  EXPECT_EQ(passes_of(map, 9), 0);
  EXPECT_EQ(passes_of(map, 10), 0);
}

TEST(IntegrateScan, ABeamWithoutReturnClearsItsWholeRayAndHitsNothing) {
  const GridMap map = map_after(1.0, false, {.free_ray_stride = 1, .free_margin_m = 0.15});
  EXPECT_FALSE(map.has_surface());
  EXPECT_EQ(passes_of(map, 10), 1);
}

TEST(IntegrateScan, FreeSpaceEndsAtItsLimitButTheHitDoesNot) {
  const GridMap map = map_after(3.0, true, {.free_ray_stride = 1, .max_free_range_m = 1.0});
  EXPECT_EQ(passes_of(map, 10), 1);
  EXPECT_EQ(passes_of(map, 11), 0);
  EXPECT_TRUE(map.is_surface({30, 0}));
}

TEST(IntegrateScan, EverySixthBeamCountsSixfoldAndEveryHitOnce) {
  GridMap map(0.1, 100.0);
  LevelScan scan;
  for (int i = 0; i < 12; ++i) scan.beams.push_back({Eigen::Vector2f(2.0F, 0.0F), true});
  integrate_scan(scan, {0.05, 0.05, 0.0}, {.free_ray_stride = 6}, map);
  EXPECT_EQ(passes_of(map, 5), 12);
  EXPECT_EQ(map.find({20, 0})->hits, 12);
}

TEST(IntegrateScan, BeamsStartAtTheLidarRotatedWithTheBody) {
  GridMap map(0.1, 100.0);
  LevelScan scan;
  scan.origin_m = {0.5, 0.0};
  scan.beams.push_back({Eigen::Vector2f(1.0F, 0.0F), true});
  integrate_scan(scan, {0.05, 0.05, M_PI / 2.0}, {.free_ray_stride = 1, .free_margin_m = 0.0}, map);
  EXPECT_TRUE(map.is_surface({0, 10}));
  EXPECT_EQ(map.find({0, 3})->passes, 0);  // between body and lidar
  EXPECT_EQ(map.find({0, 7})->passes, 1);
}

}  // namespace
}  // namespace patrol::slam::scan_integration_test
