#include "plan/routes/smooth_route.h"

#include <gtest/gtest.h>

#include "plan/routes/grid_search.h"
#include "plan/routes/line_of_sight.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::smooth_route_test {
namespace {

using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;

TEST(SmoothRoute, CutsNoCornerLosesNoClearanceAndCostsNoMoreOnThreeHundredRandomGrids) {
  int num_shorter = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 40, 0.25, seed % 2 == 0);
    const auto [start, goal] = random_ends(costs, seed);
    const Route route = GridSearch(GridSearch::Method::kAstar, 3.0).plan(costs, start, goal);
    if (route.status != PlanStatus::kFound) continue;
    const std::vector<Eigen::Vector2d> smooth = smooth_route(costs, 3.0, 2.0, route.points);
    ASSERT_TRUE(test::keeps_clear(costs, smooth)) << "seed " << seed;
    ASSERT_GE(compute_clearance(costs, smooth, 2.0), compute_clearance(costs, route.points, 2.0) - kExactTol)
        << "seed " << seed;
    double cost = 0.0;
    for (std::size_t i = 1; i < smooth.size(); ++i)
      cost += line_cost(costs, cost_factors(3.0), cell_of(smooth[i - 1]), cell_of(smooth[i])).value();
    ASSERT_LE(cost, route.cost + 1e-6) << "seed " << seed;
    ASSERT_EQ(smooth.front(), route.points.front());
    ASSERT_EQ(smooth.back(), route.points.back());
    num_shorter += test::length_of(smooth) < route.length - 0.1;
  }
  EXPECT_GT(num_shorter, 100);
}

TEST(SmoothRoute, OnFreeGroundIsOneStraightLine) {
  const Grid<Cost> costs({.resolution_m = 1.0, .width = 40, .height = 40});
  const Route route = GridSearch(GridSearch::Method::kAstar).plan(costs, {3, 3}, {37, 20});
  EXPECT_EQ(smooth_route(costs, 0.0, 2.0, route.points).size(), 2u);
}

// The detour keeps 1.5 cells from the lethal one; the straight line would pass at 0.5. Who keeps nothing may take it.
TEST(SmoothRoute, KeepsTheClearanceOfTheStretchItReplaces) {
  const Grid<Cost> costs = draw({".......",  //
                                 ".......",  //
                                 ".......",  //
                                 "...#..."});
  const std::vector<Eigen::Vector2d> detour = {{0.5, 1.5}, {1.5, 2.5}, {5.5, 2.5}, {6.5, 1.5}};
  EXPECT_EQ(smooth_route(costs, 0.0, 2.0, detour).size(), 4u);
  EXPECT_EQ(smooth_route(costs, 0.0, 0.0, detour).size(), 2u);
}

TEST(SmoothRoute, OfTwoPointsIsThoseTwo) {
  EXPECT_EQ(smooth_route(draw({"..."}), 0.0, 1.0, {{0.5, 0.5}, {2.5, 0.5}}).size(), 2u);
}

}  // namespace
}  // namespace patrol::plan::smooth_route_test
