#include "core/geometry/convex_polygon.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::convex_polygon_test {
namespace {

constexpr double kExactTol = 1e-12;  // algebra

const ConvexPolygon kSquare = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};

ConvexPolygon moved(const ConvexPolygon& polygon, double x, double y) {
  ConvexPolygon result;
  for (const auto& p : polygon) result.emplace_back(p.x() + x, p.y() + y);
  return result;
}

TEST(ConvexHull, OfASquareAndWhatLiesInItIsItsFourCorners) {
  const ConvexPolygon hull = convex_hull({{1, 1}, {2, 2}, {0, 0}, {0, 2}, {1, 0}, {2, 0}, {0.5, 1.5}, {2, 2}});
  EXPECT_EQ(hull, kSquare) << "no corner twice, none on a side";
  EXPECT_EQ(polygon_area(hull), 4.0);
}

TEST(ConvexHull, HoldsAllPointsAndTurnsLeftOnly) {
  const RandomStream random(3, "test/hull");
  ConvexPolygon points;
  for (std::uint64_t i = 0; i < 300; ++i) points.emplace_back(random.normal(i, 0), random.normal(i, 1));
  const ConvexPolygon hull = convex_hull(points);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d a = hull[i], along = hull[(i + 1) % hull.size()] - a;
    for (const auto& p : points) EXPECT_GE(along.x() * (p.y() - a.y()) - along.y() * (p.x() - a.x()), -kExactTol);
  }
}

TEST(ConvexHull, OfNothingAPointOrALineHasNoArea) {
  EXPECT_TRUE(convex_hull({}).empty());
  EXPECT_EQ(convex_hull({{1, 1}, {1, 1}}).size(), 1U);
  EXPECT_EQ(polygon_area(convex_hull({{0, 0}, {1, 1}, {3, 3}, {2, 2}})), 0.0);
  EXPECT_EQ(polygon_area({}), 0.0);
}

TEST(Intersection, OfTwoSquaresIsTheirCommonRectangle) {
  EXPECT_NEAR(polygon_area(intersect_polygons(kSquare, moved(kSquare, 0.5, 1.5))), 1.5 * 0.5, kExactTol);
  EXPECT_NEAR(polygon_area(intersect_polygons(kSquare, kSquare)), 4.0, kExactTol);
  EXPECT_EQ(polygon_area(intersect_polygons(kSquare, moved(kSquare, 3.0, 0.0))), 0.0);
  EXPECT_EQ(polygon_area(intersect_polygons(kSquare, moved(kSquare, 2.0, 0.0))), 0.0) << "a side in common";
  EXPECT_TRUE(intersect_polygons(kSquare, {{0, 0}, {1, 1}}).empty());
}

// Within |x| + |y| < 1.5 of its middle a square of side 2 loses four triangles with legs of 0.5:
// 4 - 4 (1/2) (1/2)^2 = 3.5.
TEST(Intersection, OfASquareAndOneTurnedIsAnOctagon) {
  const ConvexPolygon turned = {{1 + 1.5, 1}, {1, 1 + 1.5}, {1 - 1.5, 1}, {1, 1 - 1.5}};
  const ConvexPolygon both = intersect_polygons(kSquare, turned);
  EXPECT_EQ(both.size(), 8U);
  EXPECT_NEAR(polygon_area(both), 3.5, kExactTol);
  EXPECT_NEAR(polygon_area(intersect_polygons(turned, kSquare)), 3.5, kExactTol);
}

}  // namespace
}  // namespace patrol::convex_polygon_test
