#include "plan/planned_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"
#include "plan/astar.h"
#include "tests/support/pose_near.h"

namespace patrol::plan {
namespace {

using test::Pose2Near;
using test::VectorNear;

constexpr double kExactTol = 1e-12;

/// 3 m east, then 4 m north.
PlannedPath make_corner() { return PlannedPath({{0.0, 0.0}, {3.0, 0.0}, {3.0, 4.0}}); }

TEST(PlannedPath, LengthIsTheSumOfItsSegments) {
  EXPECT_NEAR(make_corner().length_m(), 3.0 + 4.0, kExactTol);
}

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

Grid<Cost> make_costs(int width, int height, Cost fill = kFreeCost) {
  return Grid<Cost>({.resolution_m = 0.1, .width = width, .height = height, .origin_m = {0.0, 0.0}}, fill);
}

TEST(LineCost, OnFreeGroundIsItsLength) {
  EXPECT_NEAR(line_cost_m(make_costs(50, 50), 4.0, {0.5, 0.5}, {3.5, 4.5}), 5.0, 1e-9);
}

TEST(LineCost, AtTheHighestCostAMetreCountsFive) {
  EXPECT_NEAR(line_cost_m(make_costs(50, 50, kMaxPassableCost), 4.0, {0.5, 0.5}, {2.5, 0.5}),
              2.0 * (1.0 + 4.0), 1e-9);
}

TEST(LineCost, AcrossALethalCellOrTheBorderIsInfinite) {
  Grid<Cost> costs = make_costs(50, 50);
  costs.at({20, 5}) = kLethalCost;
  EXPECT_TRUE(std::isinf(line_cost_m(costs, 4.0, {0.5, 0.55}, {3.5, 0.55})));
  EXPECT_FALSE(std::isinf(line_cost_m(costs, 4.0, {0.5, 0.65}, {3.5, 0.65})));
  EXPECT_TRUE(std::isinf(line_cost_m(costs, 4.0, {0.5, 0.65}, {5.5, 0.65})));
}

TEST(Shortcut, OnFreeGroundIsOneStraightLine) {
  const Grid<Cost> costs = make_costs(50, 50);
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.45, 0.45}, {4.45, 2.15});
  EXPECT_GT(plan.points_m.size(), 30u);
  const std::vector<Eigen::Vector2d> points = shortcut(costs, 4.0, plan.points_m);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_THAT(points.front(), VectorNear(Eigen::Vector2d(0.45, 0.45), kExactTol));
  EXPECT_THAT(points.back(), VectorNear(Eigen::Vector2d(4.45, 2.15), kExactTol));
}

/// Blobs of cost around lethal cells, at random places.
Grid<Cost> make_random_costs(std::uint64_t seed) {
  Grid<Cost> costs = make_costs(60, 60);
  const RandomStream stream(seed, "test/costs");
  for (std::uint64_t blob = 0; blob < 25; ++blob) {
    const Cell center{static_cast<int>(60.0 * stream.uniform(blob, 0)),
                      static_cast<int>(60.0 * stream.uniform(blob, 1))};
    for (int row = 0; row < 60; ++row) {
      for (int col = 0; col < 60; ++col) {
        const double distance = std::hypot(col - center.col, row - center.row);
        const Cost cost = distance <= 2.0
                              ? kLethalCost
                              : static_cast<Cost>(kMaxPassableCost * std::exp(1.0 - distance / 2.0));
        costs.at({col, row}) = std::max(costs.at({col, row}), cost);
      }
    }
  }
  return costs;
}

TEST(Shortcut, NeverCrossesLethalCellsAndNeverCostsMore) {
  const AstarSettings settings;
  AstarPlanner planner(settings);
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Grid<Cost> costs = make_random_costs(seed);
    if (costs.at({3, 3}) == kLethalCost) continue;  // a blocked start is left across lethal cells
    const PlanResult plan = planner.plan(costs, {0.35, 0.35}, {5.65, 5.65});
    if (plan.status != PlanStatus::kFound) continue;
    ++num_found;
    const auto cost_of = [&](const std::vector<Eigen::Vector2d>& points) {
      double total = 0.0;
      for (std::size_t i = 1; i < points.size(); ++i) {
        total += line_cost_m(costs, settings.cost_weight, points[i - 1], points[i]);
      }
      return total;
    };
    const std::vector<Eigen::Vector2d> shorter = shortcut(costs, settings.cost_weight, plan.points_m);
    ASSERT_TRUE(std::isfinite(cost_of(shorter))) << "seed " << seed;
    ASSERT_LE(cost_of(shorter), cost_of(plan.points_m) * (1.0 + 1e-5)) << "seed " << seed;
    ASSERT_LT(shorter.size(), plan.points_m.size()) << "seed " << seed;
    ASSERT_EQ(shorter.front(), plan.points_m.front());
    ASSERT_EQ(shorter.back(), plan.points_m.back());
  }
  EXPECT_GT(num_found, 40);
}

}  // namespace
}  // namespace patrol::plan
