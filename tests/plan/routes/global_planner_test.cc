#include "plan/routes/global_planner.h"

#include <algorithm>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/plan/routes/drawn_grid.h"
#include "tests/support/pose_near.h"

namespace patrol::plan::global_planner_test {
namespace {

using ::patrol::test::VectorNear;
using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;

/// Cells of 1 m with their lower-left corner at the origin: a cell's centre lies at half metres.
GlobalPlanner astar(GlobalPlannerSettings settings = {}) {
  settings.method = "astar";
  return GlobalPlanner(settings, 1);
}

/// By far the closest that a point of the polyline, looked at every hundredth of a cell, comes to a lethal cell's
/// square; -1 inside of one.
double sampled_clearance(const Grid<Cost>& costs, const std::vector<Eigen::Vector2d>& points, double at_most) {
  double least = at_most;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const int steps = 1 + static_cast<int>(100.0 * (points[i] - points[i - 1]).norm());
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector2d p = points[i - 1] + (points[i] - points[i - 1]) * k / steps;
      for (int row = 0; row < costs.geometry().height; ++row) {
        for (int col = 0; col < costs.geometry().width; ++col) {
          if (costs.at({col, row}) != kLethalCost) continue;
          const double dx = std::max({col - p.x(), p.x() - col - 1.0, 0.0}),
                       dy = std::max({row - p.y(), p.y() - row - 1.0, 0.0});
          least = std::min(least, dx == 0.0 && dy == 0.0 ? -1.0 : std::hypot(dx, dy));
        }
      }
    }
  }
  return least;
}

TEST(GlobalPlanner, OnFreeGroundGoesStraightFromTheExactPlaceToTheExactPlace) {
  const PlanResult plan =
      astar().plan(draw(std::vector<std::string>(10, std::string(10, '.'))), {1.12, 1.71}, {8.38, 5.99});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  ASSERT_EQ(plan.points_m.size(), 4u);  // by the centres of both ends' cells
  EXPECT_THAT(plan.points_m[0], VectorNear(Eigen::Vector2d(1.12, 1.71), kExactTol));
  EXPECT_THAT(plan.points_m[1], VectorNear(Eigen::Vector2d(1.5, 1.5), kExactTol));
  EXPECT_THAT(plan.points_m[2], VectorNear(Eigen::Vector2d(8.5, 5.5), kExactTol));
  EXPECT_THAT(plan.points_m[3], VectorNear(Eigen::Vector2d(8.38, 5.99), kExactTol));
  EXPECT_FALSE(plan.is_goal_moved);
}

TEST(GlobalPlanner, FromAPlaceToItselfIsNoWayButByTheCellsCentre) {
  const PlanResult plan = astar().plan(draw({"...", "...", "..."}), {1.2, 1.4}, {1.2, 1.4});
  EXPECT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_EQ(plan.cost_m, 0.0);
  EXPECT_THAT(plan.points_m.front(), VectorNear(Eigen::Vector2d(1.2, 1.4), kExactTol));
  EXPECT_THAT(plan.points_m.back(), VectorNear(Eigen::Vector2d(1.2, 1.4), kExactTol));
}

TEST(GlobalPlanner, LeavesABlockedStartByTheNearestFreeCell) {
  const PlanResult plan =
      astar({.start_tolerance_m = 3.0}).plan(draw({"......", "##....", "##....", "##...."}), {1.5, 0.5}, {5.5, 0.5});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_THAT(plan.points_m[0], VectorNear(Eigen::Vector2d(1.5, 0.5), kExactTol));
  EXPECT_THAT(plan.points_m[1], VectorNear(Eigen::Vector2d(2.5, 0.5), kExactTol));
}

TEST(GlobalPlanner, ABlockedGoalIsMovedToTheNearestFreeCell) {
  const PlanResult plan =
      astar({.goal_tolerance_m = 3.0}).plan(draw({"......", "....##", "....##", "....##"}), {0.5, 0.5}, {4.5, 0.5});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_TRUE(plan.is_goal_moved);
  EXPECT_THAT(plan.points_m.back(), VectorNear(Eigen::Vector2d(3.5, 0.5), kExactTol));
}

TEST(GlobalPlanner, SaysWhichEndIsBlockedAndThatThereIsNoRoute) {
  const Grid<Cost> costs = draw({"####.#..", "####.#..", "####.#..", "####.#.."});
  GlobalPlanner planner = astar({.goal_tolerance_m = 1.0, .start_tolerance_m = 1.0});
  EXPECT_EQ(planner.plan(costs, {0.5, 0.5}, {7.5, 0.5}).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(planner.plan(costs, {7.5, 0.5}, {0.5, 0.5}).status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(planner.plan(costs, {7.5, 0.5}, {90.0, 90.0}).status, PlanStatus::kGoalBlocked);  // outside
  const PlanResult cut = planner.plan(costs, {7.5, 0.5}, {4.5, 0.5});
  EXPECT_EQ(cut.status, PlanStatus::kNoRoute);
  EXPECT_TRUE(cut.points_m.empty());
}

// Eight columns on. With weight 4 a cell of the block counts 5: round it, up two rows and down again, are 4 diagonal
// steps and 4 straight ones. The line that smoothing may draw costs no more than that.
TEST(GlobalPlanner, GoesRoundWhatCostsMoreThanTheDetour) {
  const Grid<Cost> costs = draw({".........",  //
                                 "...999...",  //
                                 "...999...",  //
                                 "...999...",  //
                                 "........."});
  const PlanResult plan = astar().plan(costs, {0.5, 2.5}, {8.5, 2.5});
  EXPECT_LE(plan.cost_m, 4.0 * std::sqrt(2.0) + 4.0 + kExactTol);
  for (const Eigen::Vector2d& p : plan.points_m) EXPECT_EQ(costs.at(cell_of(p)), kFreeCost) << p.transpose();
}

class DrivenBy : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(GlobalPlanner, DrivenBy,
                         ::testing::Values("astar", "dijkstra", "theta_star", "ant_system", "ant_colony_li22",
                                           "dual_swarm_pso", "q_learning"),
                         [](const auto& parameter) { return parameter.param; });

TEST_P(DrivenBy, NeverTouchesALethalCellAndKeepsTheClearanceOfTheSearchOnFortyRandomGrids) {
  GlobalPlannerSettings settings{
      .method = GetParam(), .goal_tolerance_m = 0.0, .start_tolerance_m = 0.0, .min_clearance_m = 1.0};
  settings.family.ant_colony.ants = 8, settings.family.ant_colony.iterations = 8;
  settings.family.dual_swarm_pso.particles = 6, settings.family.dual_swarm_pso.iterations = 8;
  settings.family.q_learning.episodes = 300;
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 20, 0.3, true);
    const auto [start, goal] = random_ends(costs, seed);
    const GridGeometry& grid = costs.geometry();
    const PlanResult plan = GlobalPlanner(settings, seed).plan(costs, grid.center_of(start), grid.center_of(goal));
    if (plan.status != PlanStatus::kFound) continue;
    ++num_found;
    const Route route = make_route_planner(GetParam(), settings.family, seed)->plan(costs, start, goal);
    EXPECT_GE(sampled_clearance(costs, plan.points_m, 1.0), std::min(1.0, route.clearance) - 1e-6) << "seed " << seed;
    EXPECT_GT(sampled_clearance(costs, plan.points_m, 1.0), 0.0) << "seed " << seed;
    EXPECT_LE(plan.length_m, route.length + kExactTol) << "seed " << seed;
    EXPECT_EQ(plan.points_m,
              GlobalPlanner(settings, seed).plan(costs, grid.center_of(start), grid.center_of(goal)).points_m);
  }
  EXPECT_GT(num_found, 20);
}

TEST(GlobalPlanner, RefusesANegativeWeightAndTheOptimumThatTouches) {
  using ::testing::HasSubstr, ::testing::ThrowsMessage;
  EXPECT_THAT([] { astar({.family = {.cost_weight = -1.0}}); },
              ThrowsMessage<InputError>(HasSubstr("global_planner.cost_weight = -1")));
  EXPECT_THAT([] { GlobalPlanner({.method = "visibility_graph"}, 0); },
              ThrowsMessage<InputError>(HasSubstr("touch lethal cells")));
}

TEST(NearestPassable, EqualsBruteForceWithinItsRadius) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Grid<Cost> costs = random_grid(seed);
    const GridGeometry& grid = costs.geometry();
    const RandomStream stream(seed, "test/point");
    const Eigen::Vector2d p(30.0 * stream.uniform(0) - 3.0, 30.0 * stream.uniform(1) - 3.0);
    const double radius_m = 5.0 * stream.uniform(2);
    const Cell here = grid.cell_at(p);
    if (costs.contains(here) && costs.at(here) != kLethalCost) {
      EXPECT_EQ(nearest_passable(costs, p, radius_m), here);
      continue;
    }
    double nearest_m = std::numeric_limits<double>::infinity();
    for (int row = 0; row < grid.height; ++row) {
      for (int col = 0; col < grid.width; ++col) {
        if (costs.at({col, row}) != kLethalCost)
          nearest_m = std::min(nearest_m, (grid.center_of({col, row}) - p).norm());
      }
    }
    const std::optional<Cell> found = nearest_passable(costs, p, radius_m);
    ASSERT_EQ(found.has_value(), nearest_m <= radius_m) << "seed " << seed;
    if (found) {
      ASSERT_NEAR((grid.center_of(*found) - p).norm(), nearest_m, kExactTol);
    }
  }
}

}  // namespace
}  // namespace patrol::plan::global_planner_test
