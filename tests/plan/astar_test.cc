#include "plan/astar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <string>

#include "core/error.h"
#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::plan {
namespace {

using test::VectorNear;

constexpr double kExactTol = 1e-9;
constexpr double kResolution_m = 0.1;

/// Drawn with the highest row on top: '#' lethal, '.' free, a digit d costs d ninths of the highest passable
/// cost.
Grid<Cost> make_costs(const std::vector<std::string>& drawing) {
  Grid<Cost> costs({.resolution_m = kResolution_m,
                    .width = static_cast<int>(drawing[0].size()),
                    .height = static_cast<int>(drawing.size()),
                    .origin_m = {0.0, 0.0}});
  for (int row = 0; row < costs.geometry().height; ++row) {
    for (int col = 0; col < costs.geometry().width; ++col) {
      const char c =
          drawing[drawing.size() - 1 - static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
      costs.at({col, row}) = c == '#'   ? kLethalCost
                             : c == '.' ? kFreeCost
                                        : static_cast<Cost>((c - '0') * 28);
    }
  }
  return costs;
}

Grid<Cost> make_random_costs(std::uint64_t seed) {
  const RandomStream stream(seed, "test/costs");
  const int width = 3 + static_cast<int>(28.0 * stream.uniform(0)),
            height = 3 + static_cast<int>(28.0 * stream.uniform(1));
  const double lethal_share = 0.5 * stream.uniform(2);
  Grid<Cost> costs(
      {.resolution_m = kResolution_m, .width = width, .height = height, .origin_m = {-1.3, 2.7}});
  for (std::size_t i = 0; i < costs.values().size(); ++i) {
    const bool is_lethal = stream.uniform(3, i) < lethal_share;
    const bool is_free = stream.uniform(4, i) < 0.5;
    const auto some = static_cast<Cost>((kMaxPassableCost + 0.99) * stream.uniform(5, i));
    costs.values()[i] = is_lethal ? kLethalCost : is_free ? kFreeCost : some;
  }
  return costs;
}

/// The cheapest way by Dijkstra's algorithm, in the planner's thousandths of a cell; -1 if there is none.
long dijkstra(const Grid<Cost>& costs, Cell start, Cell goal, double cost_weight) {
  struct Entry {
    long price;
    Cell cell;
    bool operator>(const Entry& other) const { return price > other.price; }
  };
  Grid<long> best(costs.geometry(), -1);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.push({0, start});
  const auto is_lethal = [&](int col, int row) { return costs.at({col, row}) == kLethalCost; };
  while (!open.empty()) {
    const Entry entry = open.top();
    open.pop();
    const auto [col, row] = entry.cell;
    if (best.at(entry.cell) >= 0) continue;
    best.at(entry.cell) = entry.price;
    if (entry.cell == goal) return entry.price;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell next{col + dx, row + dy};
        if ((dx == 0 && dy == 0) || !costs.contains(next) || is_lethal(next.col, next.row)) continue;
        if (dx != 0 && dy != 0 && (is_lethal(next.col, row) || is_lethal(col, next.row))) continue;
        const double factor = 1.0 + cost_weight * costs.at(next) / kMaxPassableCost;
        open.push({entry.price + std::lround((dx != 0 && dy != 0 ? 1414 : 1000) * factor), next});
      }
    }
  }
  return -1;
}

/// Free cells of a grid, for random ends.
std::vector<Cell> passable_cells(const Grid<Cost>& costs) {
  std::vector<Cell> cells;
  for (int row = 0; row < costs.geometry().height; ++row) {
    for (int col = 0; col < costs.geometry().width; ++col) {
      if (costs.at({col, row}) != kLethalCost) cells.push_back({col, row});
    }
  }
  return cells;
}

TEST(Astar, CostsWhatDijkstrasRouteCostsOnAThousandRandomGrids) {
  int num_found = 0, num_impossible = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const Grid<Cost> costs = make_random_costs(seed);
    const std::vector<Cell> cells = passable_cells(costs);
    if (cells.empty()) continue;
    const RandomStream stream(seed, "test/ends");
    const auto draw = [&](std::uint64_t tick) {
      return cells[static_cast<std::size_t>(stream.uniform(tick) * static_cast<double>(cells.size()))];
    };
    const Cell start = draw(0), goal = draw(1);
    const AstarSettings settings{.cost_weight = 10.0 * stream.uniform(2)};
    const long expected = dijkstra(costs, start, goal, settings.cost_weight);
    const GridGeometry& grid = costs.geometry();
    const PlanResult plan = AstarPlanner(settings).plan(costs, grid.center_of(start), grid.center_of(goal));
    if (expected < 0) {
      ASSERT_EQ(plan.status, PlanStatus::kNoRoute) << "seed " << seed;
      ++num_impossible;
      continue;
    }
    ASSERT_EQ(plan.status, PlanStatus::kFound) << "seed " << seed;
    ASSERT_NEAR(plan.cost_m, kResolution_m * static_cast<double>(expected) / 1000.0, kExactTol)
        << "seed " << seed;
    ++num_found;
  }
  EXPECT_GT(num_found, 500);
  EXPECT_GT(num_impossible, 50);
}

TEST(Astar, RoutesStepFromCellToNeighbourAndNeverIntoALethalOne) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Grid<Cost> costs = make_random_costs(seed);
    const std::vector<Cell> cells = passable_cells(costs);
    if (cells.empty()) continue;
    const GridGeometry& grid = costs.geometry();
    const PlanResult plan =
        AstarPlanner({}).plan(costs, grid.center_of(cells.front()), grid.center_of(cells.back()));
    double length_m = 0.0;
    for (std::size_t i = 0; i < plan.points_m.size(); ++i) {
      const Cell cell = grid.cell_at(plan.points_m[i]);
      ASSERT_NE(costs.at(cell), kLethalCost) << "seed " << seed;
      if (i == 0) continue;
      const Cell before = grid.cell_at(plan.points_m[i - 1]);
      ASSERT_LE(std::max(std::abs(cell.col - before.col), std::abs(cell.row - before.row)), 1)
          << "seed " << seed;
      ASSERT_NE(costs.at({before.col, cell.row}), kLethalCost) << "a corner is cut, seed " << seed;
      ASSERT_NE(costs.at({cell.col, before.row}), kLethalCost) << "a corner is cut, seed " << seed;
      length_m += (plan.points_m[i] - plan.points_m[i - 1]).norm();
    }
    ASSERT_NEAR(plan.length_m, length_m, kExactTol);
  }
}

// 5 columns and 2 rows apart: two diagonal steps and three straight ones.
TEST(Astar, OnFreeGroundIsTheOctileDistance) {
  const Grid<Cost> costs = make_costs(std::vector<std::string>(10, std::string(10, '.')));
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.15, 0.15}, {0.65, 0.35});
  EXPECT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_NEAR(plan.length_m, 0.1 * (3.0 + 2.0 * std::sqrt(2.0)), kExactTol);
  EXPECT_NEAR(plan.cost_m, 0.1 * (3.0 + 2.0 * 1.414), kExactTol);
  EXPECT_FALSE(plan.is_goal_moved);
}

TEST(Astar, BeginsAndEndsAtTheExactPoints) {
  const Grid<Cost> costs = make_costs(std::vector<std::string>(10, std::string(10, '.')));
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.112, 0.171}, {0.838, 0.899});
  EXPECT_THAT(plan.points_m.front(), VectorNear(Eigen::Vector2d(0.112, 0.171), kExactTol));
  EXPECT_THAT(plan.points_m.back(), VectorNear(Eigen::Vector2d(0.838, 0.899), kExactTol));
}

// Eight columns on. With weight 4 a cell of the block counts 5, the straight way 5 + 3 x 5 = 20 cells; around
// it, up two rows and down again, are 4 diagonal steps and 4 straight ones: 9.7 cells. With weight 0.1 the
// straight way counts 5 + 3 x 1.1.
TEST(Astar, GoesAroundWhatCostsMoreThanTheDetour) {
  const Grid<Cost> costs = make_costs({".........",  //
                                       "...999...",  //
                                       "...999...",  //
                                       "...999...",  //
                                       "........."});
  const PlanResult dear = AstarPlanner({.cost_weight = 4.0}).plan(costs, {0.05, 0.25}, {0.85, 0.25});
  EXPECT_NEAR(dear.cost_m, 0.1 * (4.0 * 1.414 + 4.0), kExactTol);
  const PlanResult cheap = AstarPlanner({.cost_weight = 0.1}).plan(costs, {0.05, 0.25}, {0.85, 0.25});
  EXPECT_NEAR(cheap.cost_m, 0.1 * (5.0 + 3.0 * 1.1), kExactTol);
}

TEST(Astar, FromAPlaceToItselfIsNoWay) {
  const Grid<Cost> costs = make_costs({"...", "...", "..."});
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.12, 0.14}, {0.12, 0.14});
  EXPECT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_NEAR(plan.length_m, 0.0, kExactTol);
  EXPECT_EQ(plan.cost_m, 0.0);
  EXPECT_THAT(plan.points_m.back(), VectorNear(Eigen::Vector2d(0.12, 0.14), kExactTol));
}

TEST(Astar, WithinOneCellIsTheStraightLine) {
  const Grid<Cost> costs = make_costs({"...", "...", "..."});
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.11, 0.11}, {0.18, 0.11});
  EXPECT_EQ(plan.points_m.size(), 2u);
  EXPECT_NEAR(plan.length_m, 0.07, kExactTol);
}

TEST(Astar, LeavesABlockedStartByTheNearestFreeCell) {
  const Grid<Cost> costs = make_costs({"......", "##....", "##....", "##...."});
  const PlanResult plan = AstarPlanner({.start_tolerance_m = 0.3}).plan(costs, {0.15, 0.05}, {0.55, 0.05});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_THAT(plan.points_m[0], VectorNear(Eigen::Vector2d(0.15, 0.05), kExactTol));
  EXPECT_THAT(plan.points_m[1], VectorNear(Eigen::Vector2d(0.25, 0.05), kExactTol));
}

TEST(Astar, ABlockedGoalIsMovedToTheNearestFreeCell) {
  const Grid<Cost> costs = make_costs({"......", "....##", "....##", "....##"});
  const PlanResult plan = AstarPlanner({.goal_tolerance_m = 0.3}).plan(costs, {0.05, 0.05}, {0.45, 0.05});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_TRUE(plan.is_goal_moved);
  EXPECT_THAT(plan.points_m.back(), VectorNear(Eigen::Vector2d(0.35, 0.05), kExactTol));
}

TEST(Astar, SaysWhichEndIsBlocked) {
  const Grid<Cost> costs = make_costs({"####....", "####....", "####....", "####...."});
  AstarPlanner planner({.goal_tolerance_m = 0.1, .start_tolerance_m = 0.1});
  EXPECT_EQ(planner.plan(costs, {0.05, 0.05}, {0.75, 0.05}).status, PlanStatus::kStartBlocked);
  EXPECT_EQ(planner.plan(costs, {0.75, 0.05}, {0.05, 0.05}).status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(planner.plan(costs, {0.75, 0.05}, {9.0, 9.0}).status, PlanStatus::kGoalBlocked);  // outside
}

TEST(Astar, SaysThatThereIsNoRoute) {
  const Grid<Cost> costs = make_costs({"...#...", "...#...", "...#...", "...#..."});
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.05, 0.05}, {0.65, 0.05});
  EXPECT_EQ(plan.status, PlanStatus::kNoRoute);
  EXPECT_TRUE(plan.points_m.empty());
  EXPECT_EQ(plan.num_expanded, 12);  // all this side of the wall
}

TEST(Astar, PassesAGapOfOneCell) {
  const Grid<Cost> costs = make_costs({"...#...", "...#...", ".......", "...#..."});
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.05, 0.05}, {0.65, 0.05});
  ASSERT_EQ(plan.status, PlanStatus::kFound);
  EXPECT_TRUE(std::any_of(plan.points_m.begin(), plan.points_m.end(), [](const Eigen::Vector2d& p) {
    return (p - Eigen::Vector2d(0.35, 0.15)).norm() < kExactTol;
  }));
}

// The two lethal cells touch at a corner: no way between them, however short.
TEST(Astar, DoesNotSqueezeDiagonallyBetweenTwoCorners) {
  const Grid<Cost> closed = make_costs({"..#.",  //
                                        "..#.",  //
                                        "##..",  //
                                        "...."});
  EXPECT_EQ(AstarPlanner({}).plan(closed, {0.05, 0.35}, {0.35, 0.05}).status, PlanStatus::kNoRoute);
}

// A step past a single corner makes the right angle: two straight steps of 1, not one of 1.414.
TEST(Astar, DoesNotCutTheCornerOfALethalCell) {
  const Grid<Cost> costs = make_costs({"..",  //
                                       "#."});
  const PlanResult plan = AstarPlanner({}).plan(costs, {0.05, 0.15}, {0.15, 0.05});
  EXPECT_NEAR(plan.length_m, 0.2, kExactTol);
}

TEST(Astar, GivesTheSameRouteAgainWhateverItPlannedBefore) {
  AstarPlanner used({});
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Grid<Cost> costs = make_random_costs(seed);
    const std::vector<Cell> cells = passable_cells(costs);
    if (cells.empty()) continue;
    const Eigen::Vector2d start = costs.geometry().center_of(cells.front());
    const Eigen::Vector2d goal = costs.geometry().center_of(cells.back());
    const PlanResult again = used.plan(costs, start, goal);
    const PlanResult fresh = AstarPlanner({}).plan(costs, start, goal);
    ASSERT_EQ(again.points_m, fresh.points_m) << "seed " << seed;
    ASSERT_EQ(again.num_expanded, fresh.num_expanded) << "seed " << seed;
  }
}

TEST(Astar, RefusesANegativeWeight) {
  EXPECT_THAT([] { AstarPlanner({.cost_weight = -1.0}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("astar.cost_weight = -1")));
}

TEST(NearestPassable, EqualsBruteForceWithinItsRadius) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Grid<Cost> costs = make_random_costs(seed);
    const GridGeometry& grid = costs.geometry();
    const RandomStream stream(seed, "test/point");
    const Eigen::Vector2d p =
        grid.origin_m + Eigen::Vector2d(3.0 * stream.uniform(0), 3.0 * stream.uniform(1));
    const double radius_m = 0.5 * stream.uniform(2);
    const Cell here = grid.cell_at(p);
    if (costs.contains(here) && costs.at(here) != kLethalCost) {
      EXPECT_EQ(nearest_passable(costs, p, radius_m), here);
      continue;
    }
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const Cell cell : passable_cells(costs))
      nearest_m = std::min(nearest_m, (grid.center_of(cell) - p).norm());
    const std::optional<Cell> found = nearest_passable(costs, p, radius_m);
    ASSERT_EQ(found.has_value(), nearest_m <= radius_m) << "seed " << seed;
    if (found) {
      ASSERT_NEAR((grid.center_of(*found) - p).norm(), nearest_m, kExactTol);
    }
  }
}

}  // namespace
}  // namespace patrol::plan
