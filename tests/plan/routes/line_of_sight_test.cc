#include "plan/routes/line_of_sight.h"

#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"

namespace patrol::plan::line_of_sight_test {
namespace {

using test::draw, test::random_grid;

constexpr double kExactTol = 1e-12;

bool has_line_of_sight(const Grid<Cost>& costs, Cell from, Cell to) {
  return line_cost(costs, cost_factors(0.0), from, to).has_value();
}

TEST(LineOfSight, AgreesWithSeparatingAxesOnTenThousandRandomLines) {
  int num_clear = 0, num_blocked = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 24, 0.15);
    RandomSequence random(RandomStream(seed, "test/lines"), 0);
    for (int line = 0; line < 100; ++line) {
      const auto cell = [&] {
        const int col = static_cast<int>(random.index(static_cast<std::size_t>(costs.geometry().width)));
        return Cell{col, static_cast<int>(random.index(static_cast<std::size_t>(costs.geometry().height)))};
      };
      const Cell from = cell(), to = cell();
      const bool expected = test::keeps_clear(
          costs, {Eigen::Vector2d(from.col + 0.5, from.row + 0.5), Eigen::Vector2d(to.col + 0.5, to.row + 0.5)});
      ASSERT_EQ(has_line_of_sight(costs, from, to), expected) << "seed " << seed << " line " << line;
      ASSERT_EQ(has_line_of_sight(costs, to, from), expected) << "seed " << seed << " line " << line;
      (expected ? num_clear : num_blocked) += 1;
    }
  }
  EXPECT_GT(num_clear, 1000);
  EXPECT_GT(num_blocked, 1000);
}

// From the lower-left centre to the upper-right one the line passes exactly through the corner that the lethal cell has
// in common with both.
TEST(LineOfSight, EndsAtACornerThatItOnlyTouches) {
  EXPECT_FALSE(has_line_of_sight(draw({"#.", ".."}), {0, 0}, {1, 1}));
  EXPECT_TRUE(has_line_of_sight(draw({"..", ".."}), {0, 0}, {1, 1}));
}

TEST(LineOfSight, OnNeighboursIsTheRuleForSteps) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Grid<Cost> costs = random_grid(seed, 12);
    for (int row = 0; row < costs.geometry().height; ++row) {
      for (int col = 0; col < costs.geometry().width; ++col) {
        if (costs.at({col, row}) == kLethalCost) continue;
        for (const GridStep step : kGridSteps) {
          const Cell next{col + step.col, row + step.row};
          if (costs.contains(next)) {
            ASSERT_EQ(is_valid_step(costs, {col, row}, step), has_line_of_sight(costs, {col, row}, next))
                << "seed " << seed;
          }
        }
      }
    }
  }
}

// Three cells along: half of the first, the second, half of the third. The second costs 5 ninths of the weight 9: 0.5 +
// (1 + 5) + 0.5 = 7.
TEST(LinePrice, IsTheIntegralOfTheFactorsAlongTheLine) {
  EXPECT_NEAR(*line_cost(draw({".5."}), cost_factors(9.0), {0, 0}, {2, 0}), 7.0, kExactTol);
}

TEST(LinePrice, OnFreeGroundIsTheLength) {
  EXPECT_NEAR(*line_cost(draw(std::vector<std::string>(9, "..........")), cost_factors(4.0), {1, 2}, {7, 5}),
              std::hypot(6.0, 3.0), kExactTol);
  EXPECT_NEAR(*line_cost(draw({"."}), cost_factors(4.0), {0, 0}, {0, 0}), 0.0, kExactTol);
}

TEST(LinePrice, IsNoneAcrossALethalCell) { EXPECT_FALSE(line_cost(draw({".#."}), cost_factors(0.0), {0, 0}, {2, 0})); }

}  // namespace
}  // namespace patrol::plan::line_of_sight_test
