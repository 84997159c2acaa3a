#include "app/plan/route_metrics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "app/plan/route_check.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::app::route_metrics_test {
namespace {

using test::draw, test::length_of, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;

TEST(RouteMetrics, ATurnIsWhereTheDirectionChanges) {
  EXPECT_EQ(count_turns({}), 0);
  EXPECT_EQ(count_turns({{0.5, 0.5}, {2.5, 1.5}, {4.5, 2.5}}), 0);
  EXPECT_EQ(count_turns({{0.5, 0.5}, {1.5, 0.5}, {2.5, 1.5}, {3.5, 1.5}}), 2);
  EXPECT_EQ(count_turns({{0.5, 0.5}, {1.5, 0.5}, {0.5, 0.5}}), 1);  // straight back
}

// Over eight neighbours from (0, 0) to (4, 2) of an empty grid: 2 sqrt 2 + 2; straight: sqrt 20.
TEST(RouteMetrics, TheReferencesOnAnEmptyGridAreTheOctileAndTheStraightDistance) {
  const RouteMetrics metrics = evaluate_route(draw({".....", ".....", "....."}), {0, 0}, {4, 2}, PlanSettings());
  EXPECT_NEAR(metrics.octile_length.value(), 2.0 * std::sqrt(2.0) + 2.0, kExactTol);
  EXPECT_NEAR(metrics.any_angle_length.value(), std::sqrt(20.0), kExactTol);
  EXPECT_NEAR(metrics.route.length, std::sqrt(20.0), kExactTol);
  EXPECT_EQ(metrics.num_turns, 0);
  EXPECT_FALSE(metrics.octile_cost);
}

TEST(RouteMetrics, NoRouteHasNoReferences) {
  const RouteMetrics metrics = evaluate_route(draw({"..#.."}), {0, 0}, {4, 0}, PlanSettings());
  EXPECT_EQ(metrics.route.status, plan::PlanStatus::kNoRoute);
  EXPECT_FALSE(metrics.octile_length || metrics.any_angle_length || metrics.is_any_angle_skipped);
}

TEST(RouteMetrics, TheVisibilityGraphPlannerIsLeftOutOfLargeGrids) {
  PlanSettings settings;
  settings.max_any_angle_cells = 15;
  const auto metrics_on = [&](const std::vector<std::string>& drawing) {
    return evaluate_route(draw(drawing), {0, 0}, {4, 0}, settings);
  };
  EXPECT_FALSE(metrics_on({".....", ".....", "....."}).is_any_angle_skipped);
  EXPECT_TRUE(metrics_on({"......", "......", "......"}).is_any_angle_skipped);
  EXPECT_TRUE(
      metrics_on({"....." + std::string(200, '#')}).is_any_angle_skipped);  // few passable, but more than 8 * 15 in all
  settings.planner = "visibility_graph";
  EXPECT_NEAR(metrics_on({"......", "......", "......"}).any_angle_length.value(), 4.0,
              kExactTol);  // it is there anyway
}

// On ground without costs what A* makes of a wall is straightened, and its figures are those of the points that remain.
TEST(RouteMetrics, OfASmoothRouteAreItsOwnAndItKeepsClearOfLethalCells) {
  PlanSettings plain, smooth;
  plain.planner = smooth.planner = "astar";
  smooth.smooth = true;
  smooth.routes.cost_weight = plain.routes.cost_weight = 2.0;
  int num_shorter = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Grid<plan::Cost> costs = random_grid(seed, 24, 0.3, true);
    const auto [start, goal] = random_ends(costs, seed);
    const RouteMetrics rough = evaluate_route(costs, start, goal, plain),
                       straight = evaluate_route(costs, start, goal, smooth);
    ASSERT_EQ(rough.route.status, straight.route.status);
    if (rough.route.status != plan::PlanStatus::kFound) continue;
    EXPECT_EQ(validate_route(costs, straight.route, start, goal, false), std::nullopt) << "seed " << seed;
    EXPECT_NEAR(straight.route.length, length_of(straight.route.points), kExactTol);
    EXPECT_LE(straight.route.cost, rough.route.cost + kExactTol);
    EXPECT_GE(straight.route.cost, straight.route.length - kExactTol);
    num_shorter += straight.route.length < rough.route.length - kExactTol;
  }
  EXPECT_GT(num_shorter, 20);
}

// Theta* is never dearer than A*; nothing is shorter than the any-angle optimum.
TEST(RouteMetrics, LieBetweenTheReferencesOnAHundredGrids) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Grid<plan::Cost> costs = random_grid(seed, 24, 0.35);
    const auto [start, goal] = random_ends(costs, seed);
    const RouteMetrics metrics = evaluate_route(costs, start, goal, PlanSettings());
    if (metrics.route.status != plan::PlanStatus::kFound) continue;
    EXPECT_LE(metrics.route.length, *metrics.octile_length + kExactTol) << "seed " << seed;
    EXPECT_GE(metrics.route.length, *metrics.any_angle_length - kExactTol) << "seed " << seed;
  }
}

}  // namespace
}  // namespace patrol::app::route_metrics_test
