#include "plan/routes/route_planner.h"

#include <limits>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/routes/generated_grids.h"
#include "plan/routes/planners.h"
#include "tests/plan/routes/drawn_grid.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::route_planner_test {
namespace {

using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Small colonies and swarms: what is claimed of all planners must hold of them too.
std::unique_ptr<RoutePlanner> make(const std::string& name, double cost_weight = 0.0, int threads = 1) {
  RoutePlannerSettings settings{.cost_weight = cost_weight};
  settings.ant_colony.ants = 10, settings.ant_colony.iterations = 10, settings.ant_colony.threads = threads;
  settings.dual_swarm_pso.particles = 8, settings.dual_swarm_pso.iterations = 10;
  settings.q_learning.episodes = 300;
  return make_route_planner(name, settings, 1);
}

class EveryPlanner : public ::testing::TestWithParam<std::string> {
 protected:
  /// Status of the planner if no path exists.
  PlanStatus none() const { return planner->is_complete() ? PlanStatus::kNoRoute : PlanStatus::kNotFound; }

  std::unique_ptr<RoutePlanner> planner = make(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Routes, EveryPlanner, ::testing::ValuesIn(names_of(route_planners())),
                         [](const auto& parameter) { return parameter.param; });

TEST_P(EveryPlanner, FromACellToItselfHasNoLength) {
  const Route route = planner->plan(draw({"...", ".#.", "..."}), {2, 1}, {2, 1});
  EXPECT_EQ(route.status, PlanStatus::kFound);
  EXPECT_EQ(route.length, 0.0);
  ASSERT_EQ(route.points.size(), 1u);
  EXPECT_EQ(route.points[0], Eigen::Vector2d(2.5, 1.5));
  EXPECT_EQ(iterations_to_convergence(route.history, 0.01), 1);
}

TEST_P(EveryPlanner, OnAMapOfOneCellStaysThere) {
  EXPECT_EQ(planner->plan(draw({"."}), {0, 0}, {0, 0}).status, PlanStatus::kFound);
  EXPECT_EQ(planner->plan(draw({"#"}), {0, 0}, {0, 0}).status, PlanStatus::kStartBlocked);
}

TEST_P(EveryPlanner, SaysWhichEndIsBlockedOrOutside) {
  const Grid<Cost> costs = draw({"..#", "..."});
  EXPECT_EQ(planner->plan(costs, {2, 1}, {0, 0}).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(planner->plan(costs, {0, 0}, {2, 1}).status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(planner->plan(costs, {-1, 0}, {0, 0}).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(planner->plan(costs, {0, 0}, {0, 2}).status, PlanStatus::kGoalBlocked);
}

TEST_P(EveryPlanner, FindsNoRouteAcrossAWall) {
  const Route route = planner->plan(draw({"..#..", "..#..", "..#.."}), {0, 0}, {4, 2});
  EXPECT_EQ(route.status, none());
  EXPECT_TRUE(route.points.empty());
}

TEST_P(EveryPlanner, FindsNoRouteOutOfACellThatIsWalledIn) {
  EXPECT_EQ(planner->plan(draw({"...", "##.", ".#."}), {0, 0}, {2, 2}).status, none());
}

TEST_P(EveryPlanner, DoesNotSqueezeDiagonallyBetweenTwoCorners) {
  EXPECT_EQ(planner->plan(draw({"..#.", "..#.", "##..", "...."}), {0, 3}, {3, 0}).status, none());
}

// The only way is through the gap, at any angle: (0.5, 0.5) and (4.5, 0.5) see each other only round the wall.
TEST_P(EveryPlanner, PassesAGapOfOneCell) {
  const Route route = planner->plan(draw({"..#..", ".....", "..#..", "..#.."}), {0, 0}, {4, 0});
  ASSERT_EQ(route.status, PlanStatus::kFound);
  bool is_through = false;
  for (const Eigen::Vector2d& point : route.points) is_through |= point.y() >= 2.0 && point.y() <= 3.0;
  EXPECT_TRUE(is_through);
}

TEST_P(EveryPlanner,
       AgreesWithBreadthFirstSearchOnMazesAndRandomGridsIfItIsCompleteAndElseFindsNoRouteWhereThereIsNone) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Grid<Cost> costs =
        seed % 2 == 0 ? generate_grid({.kind = "maze", .size_cells = 15}, seed).costs : random_grid(seed, 16);
    if (seed % 4 == 0) costs.at({7, 6}) = costs.at({6, 7}) = kLethalCost;  // a maze that may be closed
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost) continue;
    const bool has_way = std::isfinite(test::lengths_from(costs, start).at(goal));
    const bool is_found = planner->plan(costs, start, goal).status == PlanStatus::kFound;
    ASSERT_TRUE(is_found == has_way || (!is_found && !planner->is_complete())) << "seed " << seed;
  }
}

TEST_P(EveryPlanner, StartsAtTheStartEndsAtTheGoalAndIsNoShorterThanTheOptimum) {
  const auto optimum = make("visibility_graph");
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 18, 0.3);
    const auto [start, goal] = random_ends(costs, seed);
    const Route route = planner->plan(costs, start, goal);
    if (route.status != PlanStatus::kFound) continue;
    ++num_found;
    ASSERT_EQ(route.points.front(), Eigen::Vector2d(start.col + 0.5, start.row + 0.5));
    ASSERT_EQ(route.points.back(), Eigen::Vector2d(goal.col + 0.5, goal.row + 0.5));
    ASSERT_NEAR(route.length, test::length_of(route.points), kExactTol);
    ASSERT_EQ(route.cost, route.length);
    ASSERT_GE(route.length, optimum->plan(costs, start, goal).length - kExactTol) << "seed " << seed;
    ASSERT_EQ(static_cast<int>(route.history.size()), route.num_iterations);
    ASSERT_NEAR(route.history.back(), route.cost, 1e-6);
    if (GetParam() != "visibility_graph") {
      ASSERT_TRUE(test::keeps_clear(costs, route.points)) << "seed " << seed;
    }
  }
  EXPECT_GT(num_found, 25);
}

TEST_P(EveryPlanner, HistoryNeverRises) {
  const GeneratedGrid grid = generate_grid({.size_cells = 25}, 3);
  const Route route = planner->plan(grid.costs, grid.start, grid.goal);
  for (std::size_t i = 1; i < route.history.size(); ++i) ASSERT_LE(route.history[i], route.history[i - 1]);
}

TEST_P(EveryPlanner, GivesTheSameRouteAgainWithTwoThreadsAndWhateverItPlannedBefore) {
  const auto used = make(GetParam(), 0.0, 2);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 25, 0.3);
    const auto [start, goal] = random_ends(costs, seed);
    const Route again = used->plan(costs, start, goal), fresh = make(GetParam())->plan(costs, start, goal);
    ASSERT_EQ(again.points, fresh.points) << "seed " << seed;
    ASSERT_EQ(again.history, fresh.history) << "seed " << seed;
    ASSERT_EQ(again.num_expanded, fresh.num_expanded) << "seed " << seed;
  }
}

// The corridor's middle third costs 1 + 4 in each cell: 3 + 3 x 5 for cells 3, 4, 5 of 0 ... 8, whose ends count half:
// 8 + 3 x 4 = 20.
TEST_P(EveryPlanner, PricesARouteByTheCostsItCrosses) {
  if (GetParam() == "visibility_graph") return;  // it must be 0 for visibility_graph, and refuses a weight (below)
  const Route route = make(GetParam(), 4.0)->plan(draw({"...999..."}), {0, 0}, {8, 0});
  ASSERT_EQ(route.status, PlanStatus::kFound);
  EXPECT_NEAR(route.length, 8.0, kExactTol);
  EXPECT_NEAR(route.cost, 20.0, kExactTol);
  EXPECT_NEAR(route.history.back(), 20.0, 1e-6);
}

TEST(RoutePlanners, AreEightOfWhichARobotDrivesBySeven) {
  EXPECT_EQ(route_planners().size(), 8u);
  EXPECT_EQ(drivable_route_planners().size(), 7u);
  for (const RoutePlannerRow& row : drivable_route_planners()) EXPECT_NE(row.name, "visibility_graph");
}

TEST(RoutePlanners, RefuseAWrongNameAndACostWeightForTheOptimum) {
  using ::testing::HasSubstr, ::testing::ThrowsMessage;
  EXPECT_THAT([] { make_route_planner("ants", {}, 0); },
              ThrowsMessage<InputError>(HasSubstr("planner = ants: must be one of astar, dijkstra")));
  EXPECT_THAT([] { make_route_planner("visibility_graph", {.cost_weight = 1.0}, 0); },
              ThrowsMessage<InputError>(HasSubstr("must be 0 for visibility_graph")));
  EXPECT_THAT([] { cost_factors(-1.0); }, ThrowsMessage<InputError>(HasSubstr("cost_weight = -1")));
}

TEST(IterationsToWithin, CountsFromOneToTheFirstNearEnoughToTheLast) {
  EXPECT_EQ(iterations_to_convergence({kInfinite, 120.0, 101.5, 100.9, 100.0}, 0.01), 4);
  EXPECT_EQ(iterations_to_convergence({100.0}, 0.01), 1);
  EXPECT_EQ(iterations_to_convergence({kInfinite, kInfinite}, 0.01), 0);
  EXPECT_EQ(iterations_to_convergence({}, 0.01), 0);
}

// The lethal cell is the square from (3, 3) to (4, 4).
TEST(Clearance, IsMeasuredToTheSquareFromAnyPartOfALeg) {
  const Grid<Cost> costs = draw({".......", ".......", ".......", "...#...", ".......", ".......", "......."});
  EXPECT_NEAR(compute_clearance(costs, {{0.5, 0.5}, {6.5, 0.5}}), 2.5, kExactTol);
  EXPECT_NEAR(compute_clearance(costs, {{0.5, 0.5}}), 2.5 * std::numbers::sqrt2, kExactTol);
  // From the corner (3, 4) to the lines y = x + 4 and y = x + 2: |3 - 4 + 4| / sqrt 2 and |3 - 4 + 2| / sqrt 2.
  EXPECT_NEAR(compute_clearance(costs, {{0.5, 4.5}, {2.5, 6.5}}), 3.0 / std::numbers::sqrt2, kExactTol);
  EXPECT_NEAR(compute_clearance(costs, {{1.5, 3.5}, {3.5, 5.5}}), 1.0 / std::numbers::sqrt2, kExactTol);
  EXPECT_NEAR(compute_clearance(costs, {{0.5, 0.5}, {6.5, 0.5}}, 1.0), 1.0, kExactTol);
}

TEST(Clearance, OfFreeGroundIsTheMostThatIsLookedFor) {
  EXPECT_EQ(compute_clearance(Grid<Cost>({.resolution_m = 1.0, .width = 60, .height = 60}), {{0.5, 0.5}, {50.5, 50.5}}),
            kMaxClearance);
}

TEST(ToMetres, PutsACellsCentreWhereTheGridHasIt) {
  const GridGeometry geometry{.resolution_m = 0.1, .width = 9, .height = 9, .origin_m = {-1.0, 2.0}};
  EXPECT_THAT(to_meters(geometry, {{3.5, 4.5}}).at(0),
              ::patrol::test::VectorNear(geometry.center_of({3, 4}), kExactTol));
}

}  // namespace
}  // namespace patrol::plan::route_planner_test
