#include "plan/routes/planned_path.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::planned_path_test {
namespace {

using test::Pose2Near;
using test::VectorNear;

constexpr double kExactTol = 1e-12;

/// 3 m east, then 4 m north.
PlannedPath make_corner() { return PlannedPath({{0.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}}); }

TEST(PlannedPath, LengthIsTheSumOfItsSegments) { EXPECT_NEAR(make_corner().length_m(), 3.0 + 4.0, kExactTol); }

TEST(PlannedPath, PointFiveMetresAlongIsTwoMetresPastTheCorner) {
  EXPECT_THAT(make_corner().point_at(5.0), VectorNear(Eigen::Vector2d(3.0, 2.0), kExactTol));
}

TEST(PlannedPath, PointsBeforeAndBeyondAreItsEnds) {
  EXPECT_THAT(make_corner().point_at(-1.0), VectorNear(Eigen::Vector2d(0.0, 0.0), kExactTol));
  EXPECT_THAT(make_corner().point_at(9.0), VectorNear(Eigen::Vector2d(3.0, 4.0), kExactTol));
}

TEST(PlannedPath, HeadingTurnsNinetyDegreesAtTheCorner) {
  EXPECT_NEAR(make_corner().heading_at(2.9), 0.0, kExactTol);
  EXPECT_NEAR(make_corner().heading_at(3.1), std::numbers::pi / 2.0, kExactTol);
  EXPECT_NEAR(make_corner().heading_at(100.0), std::numbers::pi / 2.0, kExactTol);
}

TEST(PlannedPath, ProjectsOntoTheNearestPoint) {
  const PathProjection beside = make_corner().project({2.0, -0.5}, 0.0, 7.0);
  EXPECT_NEAR(beside.along_m, 2.0, kExactTol);
  EXPECT_NEAR(beside.distance_m, 0.5, kExactTol);
  const PathProjection outside_the_corner = make_corner().project({3.3, -0.4}, 0.0, 7.0);
  EXPECT_NEAR(outside_the_corner.along_m, 3.0, kExactTol);
  EXPECT_NEAR(outside_the_corner.distance_m, 0.5, kExactTol);  // 3-4-5
}

// Out and back on the same line: the window says which of the two ways is meant.
TEST(PlannedPath, ProjectionStaysWithinItsWindow) {
  const PlannedPath there_and_back({{0.0, 0.0}, {5.0, 0.0}, {0.0, 0.1}});
  EXPECT_NEAR(there_and_back.project({2.0, 0.05}, 0.0, 3.0).along_m, 2.0, 0.1);
  EXPECT_NEAR(there_and_back.project({2.0, 0.05}, 6.0, 9.0).along_m, 8.0, 0.1);
  EXPECT_NEAR(there_and_back.project({2.0, 0.0}, 3.0, 4.5).along_m, 3.0, kExactTol);
}

TEST(PlannedPath, ProjectionEqualsTheNearestOfManySamples) {
  const PlannedPath path({{0.0, 0.0}, {2.0, 1.0}, {2.5, -1.0}, {4.0, 0.0}, {0.5, 2.0}});
  const RandomStream stream(1, "test/points");
  for (std::uint64_t i = 0; i < 50; ++i) {
    const Eigen::Vector2d p(5.0 * stream.uniform(i, 0), 4.0 * stream.uniform(i, 1) - 2.0);
    double nearest = std::numeric_limits<double>::infinity();
    for (double along = 0.0; along <= path.length_m(); along += 0.002) {
      nearest = std::min(nearest, (path.point_at(along) - p).norm());
    }
    const PathProjection found = path.project(p, 0.0, path.length_m());
    EXPECT_NEAR(found.distance_m, nearest, 2e-3);
    EXPECT_NEAR((path.point_at(found.along_m) - p).norm(), found.distance_m, kExactTol);
  }
}

TEST(PlannedPath, SamplesAreEvenlySpacedAndLookAlong) {
  const std::vector<Pose2> poses = make_corner().sample(0.5);
  ASSERT_EQ(poses.size(), 15u);  // 7 m in 14 steps
  EXPECT_THAT(poses[0], Pose2Near(Pose2{0.0, 0.0, 0.0}, kExactTol, kExactTol));
  EXPECT_THAT(poses[8], Pose2Near(Pose2{3.0, 1.0, std::numbers::pi / 2.0}, kExactTol, kExactTol));
  EXPECT_THAT(poses[14], Pose2Near(Pose2{3.0, 4.0, std::numbers::pi / 2.0}, kExactTol, kExactTol));
}

TEST(PlannedPath, RepeatedPointsDoNotCount) {
  const PlannedPath path({{0.0, 0.0}, {0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}});
  EXPECT_EQ(path.points_m().size(), 2u);
  EXPECT_NEAR(path.point_at(0.5).x(), 0.5, kExactTol);
}

TEST(PlannedPath, OfOnePointIsThatPointEverywhere) {
  const std::vector<Eigen::Vector2d> one = {{1.0, 2.0}};
  const PlannedPath path(one);
  EXPECT_EQ(path.length_m(), 0.0);
  EXPECT_THAT(path.point_at(3.0), VectorNear(Eigen::Vector2d(1.0, 2.0), kExactTol));
  EXPECT_NEAR(path.project({4.0, 6.0}, 0.0, 1.0).distance_m, 5.0, kExactTol);
}

TEST(PlannedPath, OfNothingIsEmpty) {
  EXPECT_TRUE(PlannedPath(std::vector<Eigen::Vector2d>()).is_empty());
  EXPECT_TRUE(PlannedPath().sample(0.1).empty());
}

}  // namespace
}  // namespace patrol::plan::planned_path_test
