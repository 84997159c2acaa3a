#include "plan/routes/grid_search.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::grid_search_test {
namespace {

using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;
constexpr double kRoot2 = std::numbers::sqrt2;

Route astar(const Grid<Cost>& costs, Cell start, Cell goal, double cost_weight = 0.0) {
  return GridSearch(GridSearch::Method::kAstar, cost_weight).plan(costs, start, goal);
}

TEST(GridSearch, AstarAndDijkstraHaveTheLengthOfThePlainSearchOnFiveHundredRandomGrids) {
  GridSearch quick(GridSearch::Method::kAstar), slow(GridSearch::Method::kDijkstra);
  int num_found = 0, num_impossible = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 40);
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost) continue;
    const double expected = test::lengths_from(costs, start).at(goal);
    const Route a = quick.plan(costs, start, goal), d = slow.plan(costs, start, goal);
    ASSERT_EQ(a.status, std::isfinite(expected) ? PlanStatus::kFound : PlanStatus::kNoRoute) << "seed " << seed;
    ASSERT_EQ(d.status, a.status) << "seed " << seed;
    if (!std::isfinite(expected)) {
      ++num_impossible;
      continue;
    }
    ++num_found;
    ASSERT_NEAR(a.length, expected, kExactTol) << "seed " << seed;
    ASSERT_NEAR(d.length, expected, kExactTol) << "seed " << seed;
    ASSERT_NEAR(a.length, test::length_of(a.points), kExactTol);
    ASSERT_TRUE(test::keeps_clear(costs, a.points)) << "seed " << seed;
    ASSERT_LE(a.num_expanded, d.num_expanded) << "seed " << seed;
  }
  EXPECT_GT(num_found, 300);
  EXPECT_GT(num_impossible, 30);
}

TEST(GridSearch, WithCostsAstarCostsWhatDijkstraCostsOnThreeHundredRandomGrids) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 30, 0.4, true);
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost) continue;
    const Route a = astar(costs, start, goal, 5.0),
                d = GridSearch(GridSearch::Method::kDijkstra, 5.0).plan(costs, start, goal);
    ASSERT_EQ(a.status, d.status) << "seed " << seed;
    ASSERT_NEAR(a.cost, d.cost, 1e-6) << "seed " << seed;
    if (a.status == PlanStatus::kFound) {
      ASSERT_NEAR(a.cost, a.history[0], 1e-6) << "what it searched by is the integral along the route, seed " << seed;
    }
  }
}

// A corridor three cells high that goes up eight and down again, a thousand times. From its upper cell in a valley to
// its lower one on a tip, a slope has one straight step, six diagonal ones, another straight one.
TEST(GridSearch, ARouteOfTwelveThousandDiagonalStepsIsExact) {
  constexpr int kTeeth = 1000, kHeight = 8, kWidth = 2 * kHeight * kTeeth + 1;
  Grid<Cost> costs({.resolution_m = 1.0, .width = kWidth, .height = kHeight + 3}, kLethalCost);
  for (int col = 0; col < kWidth; ++col) {
    const int phase = col % (2 * kHeight), row = phase <= kHeight ? phase : 2 * kHeight - phase;
    for (const int at : {row, row + 1, row + 2}) costs.at({col, at}) = kFreeCost;
  }
  EXPECT_NEAR(astar(costs, {0, 2}, {kWidth - 1, 2}).length, 2.0 * kTeeth * (2.0 + 6.0 * kRoot2), 1e-8);
}

// 5 columns and 2 rows apart: two diagonal steps and three straight ones.
TEST(GridSearch, OnFreeGroundIsTheOctileDistance) {
  const Route route = astar(Grid<Cost>({.resolution_m = 1.0, .width = 10, .height = 10}), {1, 1}, {6, 3});
  EXPECT_NEAR(route.length, 3.0 + 2.0 * kRoot2, kExactTol);
  EXPECT_EQ(route.num_iterations, 1);
  EXPECT_NEAR(route.history.at(0), route.length, 1e-8);
}

TEST(GridSearch, OnFreeGroundLooksAroundOnlyFromTheRoutesCells) {
  const Route route = astar(Grid<Cost>({.resolution_m = 1.0, .width = 200, .height = 200}), {3, 5}, {190, 80});
  EXPECT_EQ(route.num_expanded, static_cast<std::int64_t>(route.points.size()));
}

// Past the lethal corner the right angle: 2, not 1.414.
TEST(GridSearch, DoesNotCutTheCornerOfALethalCell) {
  EXPECT_NEAR(astar(draw({"..", "#."}), {0, 1}, {1, 0}).length, 2.0, kExactTol);
}

// A cell of the block counts 1 + 9 x 1 with the weight 9 (its cost is 9 ninths): straight through, 3 x 10 and 5 free
// ones, of which the ends count half. Around it, four diagonal and four straight steps.
TEST(GridSearch, GoesAroundWhatCostsMoreThanTheDetour) {
  const Grid<Cost> costs = draw({".........", "...999...", "...999...", "...999...", "........."});
  EXPECT_NEAR(astar(costs, {0, 2}, {8, 2}, 9.0).cost, 4.0 * kRoot2 + 4.0, 1e-8);
  EXPECT_NEAR(astar(costs, {0, 2}, {8, 2}, 0.1).cost, 3.0 * 1.1 + 5.0, 1e-8);
}

}  // namespace
}  // namespace patrol::plan::grid_search_test
