#include "slam/submaps/point_tree.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::slam::point_tree_test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points random_points(int count, std::uint64_t seed) {
  const RandomStream random(seed, "test/point_tree");
  Points points;
  for (int i = 0; i < count; ++i) {
    const auto u = random.uniforms(static_cast<std::uint64_t>(i));
    points.emplace_back(10.0 * u[0], 10.0 * u[1]);
  }
  return points;
}

TEST(PointTree, NearestAndWithinAreWhatASearchOfAllPointsFinds) {
  const Points points = random_points(500, 1);
  const PointTree tree(points);
  for (const Eigen::Vector2d& p : random_points(50, 2)) {
    std::size_t nearest = 0;
    std::size_t num_within = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - p).squaredNorm() < (points[nearest] - p).squaredNorm()) nearest = i;
      num_within += (points[i] - p).norm() < 1.5 ? 1 : 0;
    }
    EXPECT_EQ(tree.nearest(p).index, nearest);
    EXPECT_NEAR(tree.nearest(p).squared_distance_m2, (points[nearest] - p).squaredNorm(), 1e-12);
    const auto within = tree.within(p, 1.5);
    EXPECT_EQ(within.size(), num_within);
    if (within.empty()) continue;
    EXPECT_EQ(within.front().index, nearest);
  }
}

TEST(PointTree, CanBeMovedAndEmpty) {
  PointTree tree({{1.0, 2.0}});
  const PointTree moved = std::move(tree);
  EXPECT_EQ(moved.nearest({0.0, 0.0}).squared_distance_m2, 5.0);
  EXPECT_TRUE(PointTree({}).within({0.0, 0.0}, 10.0).empty());
}

TEST(PointTree, APointThatIsNoNumberIsRefused) {
  try {
    PointTree({{0.0, INFINITY}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "point (0, inf): must be finite");
  }
}

TEST(SurfaceNormals, OfAWallIsPerpendicularAndOfACrossHasNoWeight) {
  Points points;
  for (int i = -10; i <= 10; ++i) points.emplace_back(0.1 * i * std::cos(0.5), 0.1 * i * std::sin(0.5));
  const auto wall = surface_normals(PointTree(points), 0.35);
  for (const SurfaceNormal& at : wall) {
    EXPECT_NEAR(std::abs(at.normal.dot(Eigen::Vector2d(-std::sin(0.5), std::cos(0.5)))), 1.0, 1e-9);
    EXPECT_NEAR(at.linearity, 1.0, 1e-9);
  }
  const auto cross = surface_normals(PointTree({{0, 0}, {0.1, 0}, {-0.1, 0}, {0, 0.1}, {0, -0.1}}), 0.15);
  EXPECT_NEAR(cross[0].linearity, 0.0, 1e-9);
  const auto pair = surface_normals(PointTree({{0, 0}, {0.1, 0}}), 1.0);
  EXPECT_EQ(pair[0].normal.norm(), 0.0);
  EXPECT_EQ(pair[0].linearity, 0.0);
  EXPECT_EQ(surface_normals(PointTree({{1, 1}, {1, 1}, {1, 1}}), 1.0)[0].linearity, 0.0) << "all in one place";
}

}  // namespace
}  // namespace patrol::slam::point_tree_test
