#include "plan/routes/dual_swarm_pso.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/routes/generated_grids.h"
#include "plan/routes/grid_search.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::two_swarms_test {
namespace {

TEST(DualSwarmPso, OnFreeGroundComesWithinOnePercentOfTheOctileDistance) {
  const Grid<Cost> costs({.resolution_m = 1.0, .width = 40, .height = 40});
  const Route route = DualSwarmPso({}, 0.0, 1).plan(costs, {2, 3}, {35, 30});
  EXPECT_LT(route.length, 1.01 * test::lengths_from(costs, {2, 3}).at({35, 30}));
}

// The way straight at the goal ends in a trap; walking back out of it and round is spliced, but a via point that leads
// round at once is shorter.
TEST(DualSwarmPso, ImproveOnTheFirstParticles) {
  int num_better = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const GeneratedGrid grid = generate_grid({.kind = "rooms", .size_cells = 40}, seed);
    const Route route = DualSwarmPso({}, 0.0, seed).plan(grid.costs, grid.start, grid.goal);
    num_better += route.history.back() < route.history.front();
    EXPECT_LT(route.length, 1.1 * test::lengths_from(grid.costs, grid.start).at(grid.goal)) << "seed " << seed;
  }
  EXPECT_GE(num_better, 3);
}

TEST(DualSwarmPso, RefusesNoParticles) {
  EXPECT_THAT([] { DualSwarmPso({.particles = 0}, 0.0, 0); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("dual_swarm_pso.particles = 0")));
}

}  // namespace
}  // namespace patrol::plan::two_swarms_test
