#include "plan/routes/theta_star.h"

#include <gtest/gtest.h>

#include "plan/routes/grid_search.h"
#include "plan/routes/visibility_graph.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::theta_star_test {
namespace {

using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;

TEST(ThetaStar, IsNeverLongerThanAstarNorShorterThanTheOptimumOnThreeHundredRandomGrids) {
  GridSearch astar(GridSearch::Method::kAstar);
  ThetaStar theta;
  int num_shorter = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 40, 0.4);
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost) continue;
    const Route grid = astar.plan(costs, start, goal), any = theta.plan(costs, start, goal),
                best = VisibilityGraphPlanner().plan(costs, start, goal);
    ASSERT_EQ(any.status, grid.status) << "seed " << seed;
    ASSERT_EQ(best.status, grid.status) << "seed " << seed;
    ASSERT_LE(any.length, grid.length + kExactTol) << "seed " << seed;
    ASSERT_LE(best.length, any.length + kExactTol) << "seed " << seed;
    num_shorter += any.length < grid.length - 0.1;
  }
  EXPECT_GT(num_shorter, 100);
}

TEST(ThetaStar, MeetsNoLethalCellNorACornerOfOneByAnIndependentTest) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 30, 0.4);
    const auto [start, goal] = random_ends(costs, seed);
    ASSERT_TRUE(test::keeps_clear(costs, ThetaStar().plan(costs, start, goal).points)) << "seed " << seed;
  }
}

TEST(ThetaStar, WithCostsIsNeverDearerThanAstar) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 30, 0.3, true);
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost) continue;
    const Route grid = GridSearch(GridSearch::Method::kAstar, 3.0).plan(costs, start, goal),
                any = ThetaStar(3.0).plan(costs, start, goal);
    ASSERT_EQ(any.status, grid.status) << "seed " << seed;
    ASSERT_LE(any.cost, grid.cost + 1e-6) << "seed " << seed;
  }
}

TEST(ThetaStar, OnFreeGroundIsTheStraightLine) {
  const Route route = ThetaStar().plan(Grid<Cost>({.resolution_m = 1.0, .width = 50, .height = 50}), {2, 3}, {45, 20});
  ASSERT_EQ(route.points.size(), 2u);
  EXPECT_NEAR(route.length, std::hypot(43.0, 17.0), kExactTol);
}

// Round the end of a wall by the centre of the cell past its corner: two legs of (3, 3).
TEST(ThetaStar, TurnsAtTheCentreOfTheCellPastTheCorner) {
  const Route route = ThetaStar().plan(draw({".......",  //
                                             "...#...",  //
                                             "...#...",  //
                                             "...#..."}),
                                       {0, 0}, {6, 0});
  EXPECT_NEAR(route.length, 2.0 * std::hypot(2.0, 3.0) + 2.0, kExactTol) << "at the corner itself the line would touch";
}

}  // namespace
}  // namespace patrol::plan::theta_star_test
