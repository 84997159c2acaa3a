#include "plan/routes/generated_grids.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::generated_grids_test {
namespace {

std::ptrdiff_t count_lethal(const Grid<Cost>& costs) {
  return std::count(costs.values().begin(), costs.values().end(), kLethalCost);
}

TEST(GeneratedGrids, HaveAWayBetweenTheirEnds) {
  for (const char* const kind : {"random", "rooms", "maze"}) {
    for (const int size : {10, 37, 60}) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const GeneratedGrid grid = generate_grid({.kind = kind, .size_cells = size}, seed);
        ASSERT_TRUE(std::isfinite(test::lengths_from(grid.costs, grid.start).at(grid.goal)))
            << kind << " " << size << " seed " << seed;
        ASSERT_GE(grid.goal.col, size - 3) << kind << " " << size;
      }
    }
  }
}

TEST(GeneratedGrids, OfOneSeedAreTheSameOfAnotherNot) {
  for (const char* const kind : {"random", "rooms", "maze"}) {
    EXPECT_EQ(generate_grid({.kind = kind}, 7).costs.values(), generate_grid({.kind = kind}, 7).costs.values());
    EXPECT_NE(generate_grid({.kind = kind}, 7).costs.values(), generate_grid({.kind = kind}, 8).costs.values());
  }
}

// Standard error of the share over 10^4 cells: sqrt(0.3 x 0.7 / 10^4) = 0.0046.
TEST(GeneratedGrids, AThirdOfRandomsCellsIsLethalWithinFourStandardErrors) {
  const double share =
      static_cast<double>(count_lethal(generate_grid({.size_cells = 100, .lethal_fraction = 0.3}, 1).costs)) / 1e4;
  EXPECT_NEAR(share, 0.3, 4.0 * 0.0046);
}

// A tree of 15 x 15 rooms of one cell has one door fewer than rooms.
TEST(GeneratedGrids, AMazeIsATree) {
  const GeneratedGrid grid = generate_grid({.kind = "maze", .size_cells = 29}, 3);
  EXPECT_EQ(29 * 29 - count_lethal(grid.costs), 15 * 15 + 15 * 15 - 1);
}

TEST(GeneratedGrids, OfOneCellIsThatCell) { EXPECT_EQ(generate_grid({.size_cells = 1}, 0).costs.values().size(), 1u); }

TEST(GeneratedGrids, RefusesAnUnknownKind) {
  EXPECT_THAT([] { generate_grid({.kind = "cave"}, 0); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("grid.kind = cave")));
}

}  // namespace
}  // namespace patrol::plan::generated_grids_test
