#include "plan/routes/visibility_graph.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::visibility_graph_test {
namespace {

using test::draw, test::random_ends, test::random_grid;

constexpr double kExactTol = 1e-9;

bool is_lethal(const Grid<Cost>& costs, int col, int row) {
  return !costs.contains({col, row}) || costs.at({col, row}) == kLethalCost;
}

/// The slow, obvious version of is_visible, by separating axes: no inside of a lethal cell, nor of two side by side,
/// and through no point where two meet corner to corner. Beyond the border all is lethal.
bool can_see_slowly(const Grid<Cost>& costs, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  for (int row = -1; row <= costs.geometry().height; ++row) {
    for (int col = -1; col <= costs.geometry().width; ++col) {
      if (is_lethal(costs, col, row)) {
        if (test::meets_box(from, to, {col, row}, {col, row}, true)) return false;
        if (is_lethal(costs, col + 1, row) && test::meets_box(from, to, {col, row}, {col + 1, row}, true)) return false;
        if (is_lethal(costs, col, row + 1) && test::meets_box(from, to, {col, row}, {col, row + 1}, true)) return false;
      }
      const bool a = is_lethal(costs, col, row), b = is_lethal(costs, col + 1, row), c = is_lethal(costs, col, row + 1),
                 d = is_lethal(costs, col + 1, row + 1);
      if (a != d || b != c || a == b) continue;
      const Eigen::Vector2d squeeze(col + 1, row + 1), along = to - from, there = squeeze - from;
      const double cross = along.x() * there.y() - along.y() * there.x(),
                   share = along.dot(there) / along.squaredNorm();
      if (cross == 0.0 && share > 0.0 && share < 1.0) return false;
    }
  }
  return true;
}

/// The shortest way over the visibility graph of all of the grid's corners that border on just one lethal cell, by
/// Dijkstra's algorithm.
double shortest_slowly(const Grid<Cost>& costs, Cell start, Cell goal) {
  std::vector<Eigen::Vector2d> points{{start.col + 0.5, start.row + 0.5}, {goal.col + 0.5, goal.row + 0.5}};
  for (int y = 0; y <= costs.geometry().height; ++y) {
    for (int x = 0; x <= costs.geometry().width; ++x) {
      if (is_lethal(costs, x, y) + is_lethal(costs, x - 1, y) + is_lethal(costs, x, y - 1) +
              is_lethal(costs, x - 1, y - 1) ==
          1)
        points.emplace_back(x, y);
    }
  }
  std::vector<double> length(points.size(), std::numeric_limits<double>::infinity());
  std::set<std::size_t> open;
  for (std::size_t i = 0; i < points.size(); ++i) open.insert(i);
  length[0] = 0.0;
  while (!open.empty()) {
    const std::size_t here = *std::min_element(open.begin(), open.end(),
                                               [&](std::size_t a, std::size_t b) { return length[a] < length[b]; });
    open.erase(here);
    if (!std::isfinite(length[here])) break;
    for (const std::size_t next : open) {
      const double there = length[here] + (points[next] - points[here]).norm();
      if (there < length[next] && can_see_slowly(costs, points[here], points[next])) length[next] = there;
    }
  }
  return length[1];
}

TEST(VisibilityGraphPlanner, IsTheShortestOverAllPairsOfCornersOnFiveHundredRandomGrids) {
  int num_bent = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 11, 0.45);
    const auto [start, goal] = random_ends(costs, seed);
    if (costs.at(start) == kLethalCost || start == goal) continue;
    const Route route = VisibilityGraphPlanner().plan(costs, start, goal);
    const double expected = shortest_slowly(costs, start, goal);
    ASSERT_EQ(route.status == PlanStatus::kFound, std::isfinite(expected)) << "seed " << seed;
    if (!std::isfinite(expected)) continue;
    ASSERT_NEAR(route.length, expected, kExactTol) << "seed " << seed;
    num_bent += route.points.size() > 2;
  }
  EXPECT_GT(num_bent, 50);
}

TEST(VisibilityGraphPlanner, SeesWhatSeparatingAxesSeeOnRandomGrids) {
  int num_seen = 0, num_hidden = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 8, 0.4);
    RandomSequence random(RandomStream(seed, "test/sights"), 0);
    for (int line = 0; line < 50; ++line) {
      const auto point = [&] {
        const bool is_center = random.uniform() < 0.3;
        const int x = static_cast<int>(random.index(static_cast<std::size_t>(costs.geometry().width)));
        return HalfCellPoint{
            .x = 2 * x + is_center,
            .y = 2 * static_cast<int>(random.index(static_cast<std::size_t>(costs.geometry().height))) + is_center};
      };
      const HalfCellPoint from = point(), to = point();
      if (from == to) continue;
      const bool expected = can_see_slowly(costs, {0.5 * from.x, 0.5 * from.y}, {0.5 * to.x, 0.5 * to.y});
      ASSERT_EQ(is_visible(costs, from, to), expected)
          << "seed " << seed << ": " << from.x << " " << from.y << " to " << to.x << " " << to.y;
      (expected ? num_seen : num_hidden) += 1;
    }
  }
  EXPECT_GT(num_seen, 1000);
  EXPECT_GT(num_hidden, 1000);
}

// From (0.5, 0.5) to the wall's upper corners at (3, 3) and (4, 3), and down again.
TEST(VisibilityGraphPlanner, TouchesTheCornersThatItGoesRound) {
  const Route route = VisibilityGraphPlanner().plan(draw({".......", "...#...", "...#...", "...#..."}), {0, 0}, {6, 0});
  EXPECT_NEAR(route.length, 2.0 * std::hypot(2.5, 2.5) + 1.0, kExactTol);
  EXPECT_EQ(route.clearance, 0.0);
}

TEST(VisibilityGraphPlanner, DoesNotSqueezeBetweenTwoCorners) {
  EXPECT_EQ(VisibilityGraphPlanner().plan(draw({"..#.", "..#.", "##..", "...."}), {0, 3}, {3, 0}).status,
            PlanStatus::kNoRoute);
}

}  // namespace
}  // namespace patrol::plan::visibility_graph_test
