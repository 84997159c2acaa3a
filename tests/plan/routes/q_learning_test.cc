#include "plan/routes/q_learning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/routes/generated_grids.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::q_learning_test {
namespace {

// With rewards that are certain, a rate of 1 and hopeful beginnings, the table ends at the true lengths along the
// shortest route.
TEST(QLearning, EndsAtTheShortestRouteOfGridsOfThirtyCells) {
  for (const char* const kind : {"random", "rooms", "maze"}) {
    const GeneratedGrid grid = generate_grid({.kind = kind, .size_cells = 30}, 4);
    EXPECT_NEAR(QLearning({}, 0.0, 1).plan(grid.costs, grid.start, grid.goal).length,
                test::lengths_from(grid.costs, grid.start).at(grid.goal), 1e-9)
        << kind;
  }
}

TEST(QLearning, HasNoRouteUntilTheTableHasLearntOne) {
  const GeneratedGrid grid = generate_grid({.size_cells = 30}, 4);
  const Route route = QLearning({}, 0.0, 1).plan(grid.costs, grid.start, grid.goal);
  EXPECT_TRUE(std::isinf(route.history.front()));
  EXPECT_EQ(QLearning({.episodes = 5}, 0.0, 1).plan(grid.costs, grid.start, grid.goal).status, PlanStatus::kNotFound);
}

TEST(QLearning, RefusesALearningRateOfZero) {
  EXPECT_THAT([] { QLearning({.learning_rate = 0.0}, 0.0, 0); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("q_learning.learning_rate = 0")));
}

}  // namespace
}  // namespace patrol::plan::q_learning_test
