#include "plan/routes/ant_colony.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "plan/routes/generated_grids.h"
#include "plan/routes/grid_search.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::ant_colony_test {
namespace {

constexpr double kExactTol = 1e-9;

double gap_to_optimum(const Route& route, const GeneratedGrid& grid) {
  return route.length / GridSearch(GridSearch::Method::kAstar).plan(grid.costs, grid.start, grid.goal).length - 1.0;
}

// Straight on is a dead end; of the ways above and below the walls the one above is shorter by two steps.
TEST(AntColony, SettlesForTheShorterOfTwoWays) {
  const Grid<Cost> costs = test::draw({".........",  //
                                       ".#######.",  //
                                       "....#....",  //
                                       ".#######.",  //
                                       ".#######.",  //
                                       "........."});
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const double optimum = test::lengths_from(costs, {0, 3}).at({8, 3});
    EXPECT_NEAR(AntColony({.ants = 10, .iterations = 30}, std::nullopt, 0.0, seed).plan(costs, {0, 3}, {8, 3}).length,
                optimum, kExactTol)
        << "seed " << seed;
    EXPECT_NEAR(AntColony({.ants = 10, .iterations = 30}, ImprovedColonySettings{}, 0.0, seed)
                    .plan(costs, {0, 3}, {8, 3})
                    .length,
                optimum, kExactTol)
        << "seed " << seed;
  }
}

TEST(AntColony, OfPaper003IsWithinThreePercentOfTheOptimumOnSixtyCellsAtRandom) {
  double mean = 0.0;
  constexpr int kGrids = 4;
  for (std::uint64_t seed = 1; seed <= kGrids; ++seed) {
    const GeneratedGrid grid = generate_grid({.size_cells = 60}, seed);
    mean += gap_to_optimum(AntColony({}, ImprovedColonySettings{.shorten_paths = false}, 0.0, seed)
                               .plan(grid.costs, grid.start, grid.goal),
                           grid) /
            kGrids;
  }
  EXPECT_LT(mean, 0.03);
}

TEST(AntColony, WhoseRoutesArePulledTightIsWithinAHundredthOfAPercentOfTheOptimumOnRoomsOfAHundredCells) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const GeneratedGrid grid = generate_grid({.kind = "rooms", .size_cells = 100}, seed);
    const Route route = AntColony({.ants = 40, .iterations = 60}, ImprovedColonySettings{}, 0.0, seed)
                            .plan(grid.costs, grid.start, grid.goal);
    EXPECT_LT(gap_to_optimum(route, grid), 1e-4) << "seed " << seed;
  }
}

TEST(AntColony, EndsWithTheIterationInWhichItsStepsAreSpent) {
  const GeneratedGrid grid = generate_grid({.size_cells = 40}, 2);
  AntColony colony({.ants = 10, .iterations = 50}, std::nullopt, 0.0, 1);
  const Route all = colony.plan(grid.costs, grid.start, grid.goal);
  EXPECT_EQ(all.num_iterations, 50);
  colony.limit_steps(all.num_expanded / 2);
  const Route half = colony.plan(grid.costs, grid.start, grid.goal);
  EXPECT_GE(half.num_expanded, all.num_expanded / 2);
  EXPECT_LT(half.num_iterations, 50);
  EXPECT_EQ(half.history.back(), all.history[half.history.size() - 1]) << "what it has by then";
}

// What the force is for: the first ants already walk towards the goal.
TEST(AntColony, TheForceHalvesTheExcessOfTheFirstIteration) {
  double plain = 0.0, guided = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const GeneratedGrid grid = generate_grid({.size_cells = 60}, seed);
    plain += gap_to_optimum(
        AntColony({.iterations = 1}, std::nullopt, 0.0, seed).plan(grid.costs, grid.start, grid.goal), grid);
    guided += gap_to_optimum(AntColony({.iterations = 1}, ImprovedColonySettings{.shorten_paths = false}, 0.0, seed)
                                 .plan(grid.costs, grid.start, grid.goal),
                             grid);
  }
  EXPECT_LT(guided, 0.5 * plain);
}

TEST(AntColony, WithoutTheCoefficientTheForceChangesNothing) {
  const GeneratedGrid grid = generate_grid({.size_cells = 30}, 5);
  const AntColonySettings settings{.ants = 10, .iterations = 5};
  const Route plain = AntColony(settings, std::nullopt, 0.0, 1).plan(grid.costs, grid.start, grid.goal);
  EXPECT_EQ(AntColony(settings, ImprovedColonySettings{.coefficient = 0.0, .shorten_paths = false}, 0.0, 1)
                .plan(grid.costs, grid.start, grid.goal)
                .points,
            plain.points);
  EXPECT_NE(AntColony(settings, ImprovedColonySettings{.shorten_paths = false}, 0.0, 1)
                .plan(grid.costs, grid.start, grid.goal)
                .points,
            plain.points);
}

TEST(AntColony, SevenThreadsGiveTheRouteOfOne) {
  const GeneratedGrid grid = generate_grid({.kind = "rooms", .size_cells = 40}, 2);
  const auto plan = [&](int threads) {
    return AntColony({.ants = 23, .iterations = 10, .threads = threads}, ImprovedColonySettings{}, 0.0, 1)
        .plan(grid.costs, grid.start, grid.goal);
  };
  const Route one = plan(1), seven = plan(7);
  EXPECT_EQ(seven.points, one.points);
  EXPECT_EQ(seven.history, one.history);
  EXPECT_EQ(seven.num_expanded, one.num_expanded);
}

TEST(AntColony, AnotherSeedGivesAnotherHistory) {
  const GeneratedGrid grid = generate_grid({.size_cells = 40}, 2);
  const auto history = [&](std::uint64_t seed) {
    return AntColony({.ants = 10, .iterations = 5}, ImprovedColonySettings{}, 0.0, seed)
        .plan(grid.costs, grid.start, grid.goal)
        .history;
  };
  EXPECT_NE(history(1), history(2));
}

TEST(AntColony, RefusesNoAntsAndAnEvaporationAboveOne) {
  using ::testing::HasSubstr, ::testing::ThrowsMessage;
  EXPECT_THAT([] { AntColony({.ants = 0}, std::nullopt, 0.0, 0); },
              ThrowsMessage<InputError>(HasSubstr("ant_colony.ants = 0")));
  EXPECT_THAT([] { AntColony({.evaporation = 1.5}, std::nullopt, 0.0, 0); },
              ThrowsMessage<InputError>(HasSubstr("ant_colony.evaporation = 1.5")));
  EXPECT_THAT([] { AntColony({}, ImprovedColonySettings{.half_angle_deg = 200.0}, 0.0, 0); },
              ThrowsMessage<InputError>(HasSubstr("improved_colony.half_angle_deg = 200")));
}

}  // namespace
}  // namespace patrol::plan::ant_colony_test
