// A* of the route planners against a bare one, and the ants' colony over their number.
//   tests/bench/plan_bench
// AstarAgainstBareHeap: both search the same grid of free and lethal cells from corner to corner. The reference is A*
// as anybody would write it: a binary heap (std::priority_queue) of floats and indices, flat arrays for cost so far,
// parent and closed, the octile distance, eight neighbours, no corners cut. The subject is GridSearch with the whole
// result: exact prices, points, length, clearance. `ratio` is to be at most 1.5. AntsInIteration: `ants_per_second` is
// to be the same for all numbers of ants; with threads = 2 the time on the wall is to be about half.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "plan/routes/ant_colony.h"
#include "plan/routes/generated_grids.h"
#include "plan/routes/grid_search.h"
#include "tests/bench/ratio.h"

namespace patrol::bench {
namespace {

/// Length of the shortest route; -1 if there is none.
float bare_astar(const std::vector<char>& is_lethal, int width, int height, int start, int goal) {
  const float root2 = std::sqrt(2.0F);
  const int goal_x = goal % width, goal_y = goal / width;
  const auto octile = [&](int x, int y) {
    const int dx = std::abs(x - goal_x), dy = std::abs(y - goal_y);
    return static_cast<float>(std::max(dx, dy)) + (root2 - 1.0F) * static_cast<float>(std::min(dx, dy));
  };
  std::vector<float> length(is_lethal.size(), 1e30F);
  std::vector<int> parent(is_lethal.size(), -1);
  std::vector<char> is_closed(is_lethal.size(), 0);
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length[static_cast<std::size_t>(start)] = 0.0F;
  open.push({octile(start % width, start / width), start});
  while (!open.empty()) {
    const int here = open.top().second;
    open.pop();
    if (is_closed[static_cast<std::size_t>(here)] != 0) continue;
    is_closed[static_cast<std::size_t>(here)] = 1;
    if (here == goal) return length[static_cast<std::size_t>(goal)];
    const int x = here % width, y = here / width;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx == 0 && dy == 0) || x + dx < 0 || y + dy < 0 || x + dx >= width || y + dy >= height) continue;
        const int next = here + dy * width + dx;
        if (is_lethal[static_cast<std::size_t>(next)] != 0) continue;
        if (dx != 0 && dy != 0 &&
            (is_lethal[static_cast<std::size_t>(here + dx)] != 0 ||
             is_lethal[static_cast<std::size_t>(here + dy * width)] != 0))
          continue;
        const float there = length[static_cast<std::size_t>(here)] + (dx != 0 && dy != 0 ? root2 : 1.0F);
        if (there >= length[static_cast<std::size_t>(next)]) continue;
        length[static_cast<std::size_t>(next)] = there;
        parent[static_cast<std::size_t>(next)] = here;
        open.push({there + octile(x + dx, y + dy), next});
      }
    }
  }
  benchmark::DoNotOptimize(parent.data());
  return -1.0F;
}

void AstarAgainstBareHeap(benchmark::State& state, const char* kind) {
  const plan::GeneratedGrid grid = plan::generate_grid(
      {.kind = kind, .size_cells = static_cast<int>(state.range(0)), .room_cells = 40, .door_cells = 4}, 1);
  const int width = grid.costs.geometry().width;
  std::vector<char> is_lethal;
  for (const plan::Cost cost : grid.costs.values()) is_lethal.push_back(cost == plan::kLethalCost);
  plan::GridSearch astar(plan::GridSearch::Method::kAstar);
  Ratio ratio;
  float bare = 0.0F;
  plan::Route route;
  for (auto _ : state) {
    ratio.reference([&] {
      bare = bare_astar(is_lethal, width, width, grid.start.row * width + grid.start.col,
                        grid.goal.row * width + grid.goal.col);
    });
    state.SetIterationTime(ratio.subject([&] { route = astar.plan(grid.costs, grid.start, grid.goal); }));
  }
  if (std::abs(route.length - static_cast<double>(bare)) > 1e-3 * route.length)
    state.SkipWithError("the two lengths differ");
  ratio.report(state);
  state.counters["expanded"] = static_cast<double>(route.num_expanded);
}
BENCHMARK_CAPTURE(AstarAgainstBareHeap, random, "random")
    ->Arg(500)
    ->Arg(2000)
    ->ArgName("cells")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AstarAgainstBareHeap, rooms, "rooms")
    ->Arg(500)
    ->Arg(2000)
    ->ArgName("cells")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AstarAgainstBareHeap, maze, "maze")
    ->Arg(500)
    ->Arg(2000)
    ->ArgName("cells")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void AntsInIteration(benchmark::State& state) {
  const plan::GeneratedGrid grid = plan::generate_grid({.size_cells = 100}, 1);
  const int ants = static_cast<int>(state.range(0));
  plan::AntColony colony({.ants = ants, .iterations = 10, .threads = static_cast<int>(state.range(1))},
                         plan::ImprovedColonySettings{}, 0.0, 1);
  for (auto _ : state) benchmark::DoNotOptimize(colony.plan(grid.costs, grid.start, grid.goal));
  state.counters["ants_per_second"] = benchmark::Counter(10.0 * ants, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(AntsInIteration)
    ->ArgsProduct({{50, 200, 800}, {1, 2}})
    ->ArgNames({"ants", "threads"})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace patrol::bench
