#include "app/plan/route_check.h"

#include <gtest/gtest.h>

#include "plan/routes/theta_star.h"
#include "plan/routes/visibility_graph.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::app::route_check_test {
namespace {

using test::draw, test::keeps_clear, test::random_ends, test::random_grid;

plan::Route route_over(std::vector<Eigen::Vector2d> points) {
  plan::Route route;
  route.points = std::move(points);
  return route;
}

TEST(RouteCheck, AStraightLinePastACornerMayNotTouchIt) {
  const Grid<plan::Cost> costs = draw({"..", "#."});  // the lethal cell's corner lies on the diagonal's middle
  EXPECT_FALSE(validate_route(costs, route_over({{0.5, 1.5}, {1.5, 1.5}, {1.5, 0.5}}), {0, 1}, {1, 0}, false));
  EXPECT_EQ(validate_route(costs, route_over({{0.5, 1.5}, {1.5, 0.5}}), {0, 1}, {1, 0}, false),
            "meets the lethal cell 0, 0");
  EXPECT_FALSE(validate_route(costs, route_over({{0.5, 1.5}, {1.5, 0.5}}), {0, 1}, {1, 0}, true));
}

TEST(RouteCheck, ADiagonalSqueezeIsRefusedEvenWhereTouchingIsAllowed) {
  const Grid<plan::Cost> costs = draw({".#", "#."});
  EXPECT_TRUE(validate_route(costs, route_over({{0.5, 1.5}, {1.5, 0.5}}), {0, 1}, {1, 0}, false));
  EXPECT_EQ(validate_route(costs, route_over({{0.5, 1.5}, {1.5, 0.5}}), {0, 1}, {1, 0}, true),
            "passes between two lethal cells before 1.5, 0.5");
}

TEST(RouteCheck, AWayAlongTheSideBetweenTwoLethalCellsIsRefused) {
  const Grid<plan::Cost> costs = draw({".#.", ".#."});
  EXPECT_TRUE(
      validate_route(costs, route_over({{0.5, 0.5}, {1.0, 1.0}, {2.0, 1.0}, {2.5, 0.5}}), {0, 0}, {2, 0}, true));
}

TEST(RouteCheck, AWayAlongTheBorderPastALethalCellIsRefused) {
  const Grid<plan::Cost> costs = draw({".#."});
  EXPECT_TRUE(
      validate_route(costs, route_over({{0.5, 0.5}, {1.0, 1.0}, {2.0, 1.0}, {2.5, 0.5}}), {0, 0}, {2, 0}, true));
}

TEST(RouteCheck, ARouteMustLeadFromTheStartToTheGoalByCentresAndCorners) {
  const Grid<plan::Cost> costs = draw({"..."});
  EXPECT_FALSE(validate_route(costs, route_over({{0.5, 0.5}, {2.5, 0.5}}), {0, 0}, {2, 0}, false));
  EXPECT_TRUE(validate_route(costs, route_over({{0.5, 0.5}, {1.5, 0.5}}), {0, 0}, {2, 0}, false));
  EXPECT_TRUE(validate_route(costs, route_over({{1.5, 0.5}, {2.5, 0.5}}), {0, 0}, {2, 0}, false));
  EXPECT_TRUE(validate_route(costs, route_over({}), {0, 0}, {2, 0}, false));
  EXPECT_TRUE(validate_route(costs, route_over({{0.5, 0.5}, {1.25, 0.5}, {2.5, 0.5}}), {0, 0}, {2, 0}, false));
  EXPECT_TRUE(
      validate_route(costs, route_over({{0.5, 0.5}, {3.5, 0.5}, {2.5, 0.5}}), {0, 0}, {2, 0}, false));  // outside
  EXPECT_FALSE(validate_route(costs, route_over({{1.5, 0.5}}), {1, 0}, {1, 0}, false));
  EXPECT_TRUE(validate_route(draw({".#."}), route_over({{1.5, 0.5}}), {1, 0}, {1, 0}, false));
}

TEST(RouteCheck, FindsExactlyTheLinesThatMeetALethalSquareByTheirSeparatingAxes) {
  int num_clear = 0, num_blocked = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const Grid<plan::Cost> costs = random_grid(seed, 12, 0.2);
    const auto [start, goal] = random_ends(costs, seed);
    const std::vector<Eigen::Vector2d> line = {{start.col + 0.5, start.row + 0.5}, {goal.col + 0.5, goal.row + 0.5}};
    const bool is_clear = keeps_clear(costs, line);
    EXPECT_EQ(!validate_route(costs, route_over(line), start, goal, false), is_clear) << "seed " << seed;
    (is_clear ? num_clear : num_blocked) += 1;
  }
  EXPECT_GT(num_clear, 500);
  EXPECT_GT(num_blocked, 500);
}

// By a corner of a cell: what the optimum's own line of sight refuses is refused, and what it allows is allowed unless
// the corner itself is pinched.
TEST(RouteCheck, WhereTouchingIsAllowedAgreesWithTheOptimumsLineOfSight) {
  int num_clear = 0, num_blocked = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    const Grid<plan::Cost> costs = random_grid(seed, 8, 0.25);
    const auto [start, goal] = random_ends(costs, seed);
    const GridGeometry& grid = costs.geometry();
    const RandomStream stream(seed, "test/corner");
    const int x = static_cast<int>(stream.uniform(0) * (grid.width + 1)),
              y = static_cast<int>(stream.uniform(1) * (grid.height + 1));
    const plan::Route route =
        route_over({{start.col + 0.5, start.row + 0.5}, {x, y}, {goal.col + 0.5, goal.row + 0.5}});
    const plan::HalfCellPoint from{.x = 2 * start.col + 1, .y = 2 * start.row + 1}, corner{.x = 2 * x, .y = 2 * y},
        to{.x = 2 * goal.col + 1, .y = 2 * goal.row + 1};
    const bool sees = plan::is_visible(costs, from, corner) && plan::is_visible(costs, corner, to);
    const auto is_lethal = [&](int col, int row) {
      return !costs.contains({col, row}) || costs.at({col, row}) == plan::kLethalCost;
    };
    const bool is_pinched =
        (is_lethal(x, y) && is_lethal(x - 1, y - 1)) || (is_lethal(x - 1, y) && is_lethal(x, y - 1));
    EXPECT_EQ(!validate_route(costs, route, start, goal, true), sees && !is_pinched) << "seed " << seed;
    (sees && !is_pinched ? num_clear : num_blocked) += 1;
  }
  EXPECT_GT(num_clear, 200);
  EXPECT_GT(num_blocked, 200);
}

TEST(RouteCheck, PassesEveryRouteOfThetaStarAndOfTheOptimumOnThreeHundredGrids) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const Grid<plan::Cost> costs = random_grid(seed, 24, 0.4);
    const auto [start, goal] = random_ends(costs, seed);
    const plan::Route theta = plan::ThetaStar().plan(costs, start, goal),
                      optimum = plan::VisibilityGraphPlanner().plan(costs, start, goal);
    if (theta.status == plan::PlanStatus::kFound) {
      EXPECT_EQ(validate_route(costs, theta, start, goal, false), std::nullopt) << "seed " << seed;
    }
    if (optimum.status == plan::PlanStatus::kFound) {
      EXPECT_EQ(validate_route(costs, optimum, start, goal, true), std::nullopt) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace patrol::app::route_check_test
