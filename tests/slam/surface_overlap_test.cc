#include "slam/surface_overlap.h"

#include <gtest/gtest.h>

namespace patrol::slam::surface_overlap_test {
namespace {

TEST(SurfaceOverlap, CountsPointsOnASurfaceInFreeSpaceAndInUnknownCells) {
  GridMap map(0.05, 100.0);
  map.add_free_ray({0.0, 0.02}, {1.9, 0.02}, 1, false);
  map.add_hit({2.02, 0.02});
  const std::vector<MatchPoint> points = {{{2.02, 0.02}, 2.0},   // on the surface
                                          {{2.12, 0.02}, 2.0},   // two cells behind it
                                          {{2.17, 0.02}, 2.0},   // three cells behind it: unknown
                                          {{1.02, 0.02}, 1.0}};  // in free space
  const SurfaceOverlap overlap = measure_overlap(map, points, {}, 2);
  EXPECT_EQ(overlap.num_points, 4);
  EXPECT_EQ(overlap.num_observed, 3);
  EXPECT_EQ(overlap.num_matched, 2);
  EXPECT_DOUBLE_EQ(overlap.overlap_ratio(), 0.75);
  EXPECT_DOUBLE_EQ(overlap.inlier_ratio(), 2.0 / 3.0);
}

TEST(SurfaceOverlap, OfNoPointsIsZero) {
  const SurfaceOverlap overlap = measure_overlap(GridMap(0.05, 100.0), {}, {}, 2);
  EXPECT_EQ(overlap.overlap_ratio(), 0.0);
  EXPECT_EQ(overlap.inlier_ratio(), 0.0);
}

}  // namespace
}  // namespace patrol::slam::surface_overlap_test
