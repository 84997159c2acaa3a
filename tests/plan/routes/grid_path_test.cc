#include "plan/routes/grid_path.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::grid_path_test {
namespace {

constexpr double kExactTol = 1e-12;

StepGraph graph_of(const std::vector<std::string>& drawing) {
  return StepGraph(test::draw(drawing), cost_factors(9.0));
}

/// The open step that comes first in kGridSteps: right, up, left, down.
std::size_t first_open(std::uint32_t, unsigned open) { return static_cast<std::size_t>(std::countr_zero(open)); }

TEST(StepGraph, HasTheStepsThatTheRuleAllows) {
  const StepGraph graph = graph_of({".#",  //
                                    ".."});
  EXPECT_EQ(graph.steps[graph.index_of({0, 0})], 0b00000011) << "right and up; not across the corner";
  EXPECT_EQ(graph.steps[graph.index_of({1, 1})], 0) << "out of a lethal cell none";
}

// From 1 to 1 + 9 x 5/9 = 6: half of each.
TEST(StepGraph, PricesAStepByBothItsCells) {
  const StepGraph graph = graph_of({"..",  //
                                    ".5"});
  EXPECT_NEAR(graph.step_cost(graph.index_of({0, 0}), 0), 3.5, kExactTol);
  EXPECT_NEAR(graph.step_cost(graph.index_of({1, 0}), 1), 3.5, kExactTol);
  EXPECT_NEAR(graph.step_cost(graph.index_of({0, 1}), 7), 3.5 * std::numbers::sqrt2, kExactTol);
}

// To the right first: into the dead end of three cells, back, and up.
TEST(GridPathBuilder, GoesBackOutOfADeadEnd) {
  const StepGraph graph = graph_of({"....",  //
                                    ".###",  //
                                    "...."});
  GridPathBuilder path_builder(graph);
  const GridPath path = path_builder.build(graph.index_of({0, 0}), graph.index_of({0, 2}), first_open);
  ASSERT_EQ(path.cells.size(), 2u);
  EXPECT_EQ(graph.cell_of(path.cells[1]), (Cell{0, 1}));
  EXPECT_EQ(path.num_steps, 3 + 3 + 2);
}

TEST(GridPathBuilder, ThatHasBeenEverywhereSaysThatThereIsNoWay) {
  const StepGraph graph = graph_of({"..#.",  //
                                    "..#."});
  EXPECT_TRUE(GridPathBuilder(graph).build(graph.index_of({0, 0}), graph.index_of({3, 0}), first_open).cells.empty());
}

// Right along the row, up, and back along the next to the cell above the start: spliced, it is the one step up.
TEST(GridPathBuilder, SplicesWhatLiesBetweenNeighbours) {
  const StepGraph graph = graph_of({"....",  //
                                    "...."});
  GridPathBuilder path_builder(graph);
  GridPath path = path_builder.build(graph.index_of({0, 0}), graph.index_of({0, 1}), first_open);
  EXPECT_EQ(path.cells.size(), 7u);
  path_builder.remove_loops(path, graph.index_of({0, 1}));
  ASSERT_EQ(path.cells.size(), 1u);
  EXPECT_EQ(path.directions[0], 1);
}

// Right, left, right, right: the loop back to the start goes.
TEST(GridPathBuilder, SplicesLoops) {
  const StepGraph graph = graph_of({"....."});
  GridPathBuilder path_builder(graph);
  GridPath path{.cells = {0, 1, 0, 1, 2}, .directions = {0, 2, 0, 0, 0}};
  path_builder.remove_loops(path, 3);
  EXPECT_EQ(path.cells, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_NEAR(path_cost(graph, path), 3.0, kExactTol);
}

/// Random path without a repeated cell.
GridPath random_path(GridPathBuilder& path_builder, std::uint32_t from, std::uint32_t to, std::uint64_t seed) {
  RandomSequence random(RandomStream(seed, "test/walk"), 0);
  return path_builder.build(from, to, [&](std::uint32_t, unsigned open) {
    std::size_t direction = random.index(8);
    while ((open >> direction & 1u) == 0) direction = random.index(8);
    return direction;
  });
}

TEST(GridPathBuilder, ShortensAnyPathOverOpenGroundToTheOctileDistance) {
  const StepGraph graph = graph_of(std::vector<std::string>(15, std::string(20, '.')));
  GridPathBuilder path_builder(graph);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomStream stream(seed, "test/ends");
    const Cell a{static_cast<int>(20.0 * stream.uniform(0)), static_cast<int>(15.0 * stream.uniform(1))},
        b{static_cast<int>(20.0 * stream.uniform(2)), static_cast<int>(15.0 * stream.uniform(3))};
    if (a == b) continue;
    GridPath path = random_path(path_builder, graph.index_of(a), graph.index_of(b), seed);
    path_builder.shorten(path, graph.index_of(b));
    const int dx = std::abs(a.col - b.col), dy = std::abs(a.row - b.row);
    EXPECT_NEAR(path_cost(graph, path), std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy), 1e-9)
        << "seed " << seed;
  }
}

TEST(GridPathBuilder, AShortenedPathIsValidAndNeverMoreExpensiveOnTwoHundredRandomGrids) {
  int num_paths = 0, num_cheaper = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Grid<Cost> costs = test::random_grid(seed, 30, 0.3, true);
    const auto [start, goal] = test::random_ends(costs, seed);
    const StepGraph graph(costs, cost_factors(seed % 2 == 0 ? 0.0 : 3.0));
    GridPathBuilder path_builder(graph);
    if (start == goal || costs.at(start) == kLethalCost) continue;
    GridPath path = random_path(path_builder, graph.index_of(start), graph.index_of(goal), seed);
    if (path.cells.empty()) continue;
    path_builder.remove_loops(path, graph.index_of(goal));
    const double before = path_cost(graph, path);
    path_builder.shorten(path, graph.index_of(goal));
    std::uint32_t here = graph.index_of(start);
    for (std::size_t i = 0; i < path.cells.size(); ++i) {
      ASSERT_EQ(path.cells[i], here) << "seed " << seed;
      ASSERT_TRUE(graph.has_step(here, path.directions[i])) << "seed " << seed;
      here = graph.next(here, path.directions[i]);
    }
    ASSERT_EQ(here, graph.index_of(goal)) << "seed " << seed;
    ASSERT_LE(path_cost(graph, path), before + 1e-6) << "seed " << seed;
    ++num_paths, num_cheaper += path_cost(graph, path) < before - 1e-6;
  }
  EXPECT_GT(num_paths, 120);
  EXPECT_GT(num_cheaper, num_paths / 2);
}

}  // namespace
}  // namespace patrol::plan::grid_path_test
