#include "plan/routes/held_karp_bound.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::plan::tour_bound_test {
namespace {

constexpr double kExactTol = 1e-9;

TourProblem random_problem(std::uint64_t seed, std::size_t count) {
  const RandomStream stream(seed, "test/bound");
  TourProblem problem{.travel = std::vector<std::vector<double>>(count, std::vector<double>(count, 0.0))};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) problem.travel[i][j] = i == j ? 0.0 : 10.0 + 90.0 * stream.uniform(i, j);
  }
  return problem;
}

// The bound of an open way is looser than a round's: the station of no distance that joins its ends may hang on where
// no tour would begin.
TEST(TourBound, NeverExceedsTheExactOrderOfTwoHundredProblemsAndIsWithinTwoPercentOfRounds) {
  double round_gap = 0.0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    TourProblem problem = random_problem(seed, 8);
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = 0; j < i; ++j) problem.travel[i][j] = problem.travel[j][i];
    }
    if (seed % 2 == 0) problem.start = problem.end = 3;
    if (seed % 4 == 1) problem.start = 2, problem.end = 6;
    const double exact = solve_station_order(problem, {}, 1).completion, bound = held_karp_bound(problem, exact, 300);
    ASSERT_LE(bound, exact + kExactTol) << "seed " << seed;
    if (seed % 2 == 0) round_gap += (exact / bound - 1.0) / 100.0;
  }
  EXPECT_LT(round_gap, 0.02);
}

TEST(TourBound, OfOneWayMatricesIsBelowTheExactOrderToo) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const TourProblem problem = random_problem(seed, 8);
    const double exact = solve_station_order(problem, {}, 1).completion;
    ASSERT_LE(held_karp_bound(problem, exact, 300), exact + kExactTol) << "seed " << seed;
  }
}

// 4 of service in each, and the last cannot end before 100 + 4.
TEST(TourBound, CountsServiceAndTheLatestOpening) {
  TourProblem problem{.travel = {{0.0, 10.0, 20.0}, {10.0, 0.0, 10.0}, {20.0, 10.0, 0.0}},
                      .stations = std::vector<TourProblem::Station>(3, {.service = 4.0}),
                      .start = {},
                      .end = {}};
  EXPECT_NEAR(held_karp_bound(problem, 32.0, 300), 20.0 + 12.0, 1e-6);
  problem.stations[1].earliest = 100.0;
  EXPECT_NEAR(held_karp_bound(problem, 150.0, 300), 104.0, 1e-6);
}

TEST(TourBound, IsInfiniteIfTheStationsDoNotHangTogether) {
  const double none = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(
      std::isinf(held_karp_bound({.travel = {{0.0, none, none}, {none, 0.0, 1.0}, {none, 1.0, 0.0}}}, 10.0, 50)));
}

}  // namespace
}  // namespace patrol::plan::tour_bound_test
