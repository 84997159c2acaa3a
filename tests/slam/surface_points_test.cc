#include "slam/surface_points.h"

#include <gtest/gtest.h>

namespace patrol::slam::surface_points_test {
namespace {

/// A wall along y = 1 from x = 0 to 4, seen from below by beams straight up every 2.5 cm, twice.
GridMap wall_from_below() {
  GridMap map(0.05, 40.0);
  for (int round = 0; round < 2; ++round) {
    for (double x = 0.0125; x < 4.0; x += 0.025) {
      map.add_free_ray({x, 0.0}, {x, 0.85}, 1, false);
      map.add_hit({x, 1.01});
    }
  }
  return map;
}

TEST(SurfacePoints, AreTheMeansOfTheHitsTenCentimetersApart) {
  const std::vector<Eigen::Vector2d> points = surface_points(wall_from_below());
  ASSERT_EQ(points.size(), 40U);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i].y(), 1.01, 1e-6);
    EXPECT_NEAR(points[i].x(), 0.05 + 0.1 * static_cast<double>(i), 0.013);
  }
}

TEST(SurfacePoints, ASingleHitIsNoSurface) {
  GridMap map(0.05, 40.0);
  map.add_hit({1.0, 1.0});
  EXPECT_TRUE(surface_points(map).empty());
}

TEST(FreeSpaceNormals, AWallNormalPointsToTheObservers) {
  const GridMap map = wall_from_below();
  const std::vector<Eigen::Vector2d> points = surface_points(map),
                                     free_space_normals = estimate_free_space_normals(points, map, 0.3);
  for (std::size_t i = 3; i + 3 < points.size(); ++i) {
    EXPECT_NEAR(free_space_normals[i].norm(), 1.0, 1e-9);
    EXPECT_LT(free_space_normals[i].y(), -0.99) << points[i].transpose();
  }
}

TEST(FreeSpaceNormals, APostObservedFromAllSidesHasNoNormal) {
  GridMap map(0.05, 40.0);
  const Eigen::Vector2d post(1.025, 1.025);
  for (int i = 0; i < 72; ++i) {
    const Eigen::Vector2d outwards(std::cos(0.0873 * i), std::sin(0.0873 * i));
    map.add_free_ray(post + 0.6 * outwards, post + 0.1 * outwards, 1, false);
    map.add_hit(post);
  }
  const std::vector<Eigen::Vector2d> points = surface_points(map);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_EQ(estimate_free_space_normals(points, map, 0.3)[0], Eigen::Vector2d(0.0, 0.0));
}

TEST(FreeSpaceNormals, WithoutFreeSpaceThereIsNoNormal) {
  GridMap map(0.05, 40.0);
  map.add_hit({1.0, 1.0});
  EXPECT_EQ(estimate_free_space_normals({{1.0, 1.0}}, map, 0.3)[0], Eigen::Vector2d(0.0, 0.0));
}

}  // namespace
}  // namespace patrol::slam::surface_points_test
