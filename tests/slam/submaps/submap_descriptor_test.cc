#include "slam/submaps/submap_descriptor.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/submap_points.h"

namespace patrol::slam::submap_descriptor_test {
namespace {

using test::make_yard, test::sample_walls;
using Points = std::vector<Eigen::Vector2d>;

constexpr double kExactTol = 1e-12;  // algebra

const GridMap kNoMap(0.05, 100.0);

Points moved(const Points& points, const Pose2& T) {
  Points result;
  for (const auto& p : points) result.push_back(T * p);
  return result;
}

// Four corners of a square of side 2: distances 2 (four) and 2.828 (two), between the bins 2 and 3.
TEST(SubmapDescriptor, OfTheCornersOfASquareEqualsItsGeometry) {
  const SubmapDescriptor descriptor = describe_submap({{0, 0}, {2, 0}, {2, 2}, {0, 2}}, kNoMap, {});
  EXPECT_EQ(descriptor.num_points, 4U);
  EXPECT_EQ(descriptor.center, Eigen::Vector2d(1, 1));
  EXPECT_NEAR(descriptor.radius_m, std::sqrt(2.0), kExactTol);
  EXPECT_EQ(polygon_area(descriptor.hull), 4.0);
  const double beyond = 2.0 * std::sqrt(2.0) - 2.0;  // of the diagonal, in bins
  EXPECT_NEAR(descriptor.distances[2], (4.0 + 2.0 * (1.0 - beyond)) / 6.0, kExactTol);
  EXPECT_NEAR(descriptor.distances[3], 2.0 * beyond / 6.0, kExactTol);
  EXPECT_NEAR(std::accumulate(descriptor.distances.begin(), descriptor.distances.end(), 0.0), 1.0, kExactTol);
}

TEST(SubmapDescriptor, FrameIndependentPartsStayWhenTheFrameMoves) {
  const Points points = sample_walls(make_yard(), {});
  const SubmapDescriptor here = describe_submap(points, kNoMap, {}),
                         there = describe_submap(moved(points, {30.0, -20.0, 2.2}), kNoMap, {});
  EXPECT_NEAR(here.radius_m, there.radius_m, 1e-10);
  EXPECT_NEAR(polygon_area(here.hull), polygon_area(there.hull), 1e-9);
  EXPECT_LT(histogram_difference(here.distances, there.distances), 1e-9);
}

TEST(SubmapDescriptor, DirectionsRotateWithTheFrame) {
  const Points points =
      sample_walls(make_yard(), {}, {.spacing_m = 0.11});  // none just so far apart as a neighborhood reaches
  const SubmapDescriptor here = describe_submap(points, kNoMap, {});
  // 25 degrees are five bins of 5.
  const SubmapDescriptor turned = describe_submap(moved(points, {1.0, 2.0, 25.0 * kDegree}), kNoMap, {});
  EXPECT_NEAR(circular_correlation(turned.directions, here.directions, 5), 1.0, 1e-9);
  EXPECT_LT(circular_correlation(turned.directions, here.directions, 0), 0.2);
  const SubmapDescriptor between = describe_submap(moved(points, {1.0, 2.0, 27.5 * kDegree}), kNoMap, {});
  EXPECT_GT(circular_correlation(between.directions, here.directions, 5), 0.6) << "half a bin off";
}

// Walls of 20 m along x and 10 m along y, less what lies in the corners, which count little.
TEST(SubmapDescriptor, AnUprightYardHasTwoDirections) {
  test::RoomWorld box;
  box.add_box(0.0, 0.0, 10.0, 5.0);
  const SubmapDescriptor descriptor = describe_submap(sample_walls(box, {}), kNoMap, {});
  EXPECT_NEAR(descriptor.directions[0], 2.0 / 3.0, 0.05);
  EXPECT_NEAR(descriptor.directions[18], 1.0 / 3.0, 0.05);
  EXPECT_GT(descriptor.directions[0] + descriptor.directions[18], 0.9);
}

TEST(SubmapDescriptor, OfTwoPointsIsRefused) {
  try {
    describe_submap({{0, 0}, {1, 1}}, kNoMap, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "submap: 2 surface points: must be at least 3");
  }
}

TEST(HistogramDifference, IsZeroForEqualAndOneForDisjointHistograms) {
  EXPECT_EQ(histogram_difference({0.5, 0.5, 0.0}, {0.5, 0.5, 0.0}), 0.0);
  EXPECT_EQ(histogram_difference({1.0, 0.0, 0.0}, {0.0, 0.5, 0.5}), 1.0);
  EXPECT_EQ(histogram_difference({0.5, 0.5}, {1.0, 0.0}), 0.5);
}

TEST(CircularCorrelation, FindsARotationAndNothingInUniformHistograms) {
  const std::vector<double> a = {0.5, 0.3, 0.1, 0.1}, b = {0.3, 0.1, 0.1, 0.5};  // a is b one bin on
  EXPECT_NEAR(circular_correlation(a, b, 1), 1.0, kExactTol);
  EXPECT_NEAR(circular_correlation(a, b, -3), 1.0, kExactTol);
  EXPECT_LT(circular_correlation(a, b, 0), 0.5);
  EXPECT_EQ(circular_correlation(a, {0.25, 0.25, 0.25, 0.25}, 0), 0.0);
}

}  // namespace
}  // namespace patrol::slam::submap_descriptor_test
