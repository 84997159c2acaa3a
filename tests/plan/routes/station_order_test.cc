#include "plan/routes/station_order.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "plan/routes/held_karp_bound.h"

namespace patrol::plan::tour_order_test {
namespace {

constexpr double kExactTol = 1e-9;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

TourProblem random_problem(std::uint64_t seed, std::size_t count, bool is_symmetric = true) {
  const RandomStream stream(seed, "test/tour");
  TourProblem problem{.travel = std::vector<std::vector<double>>(count, std::vector<double>(count, 0.0))};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      problem.travel[i][j] =
          100.0 * std::hypot(stream.uniform(0, i) - stream.uniform(0, j), stream.uniform(1, i) - stream.uniform(1, j));
      if (!is_symmetric) problem.travel[i][j] *= 1.0 + stream.uniform(2, i * count + j);
    }
  }
  return problem;
}

/// Stations evenly round a circle of radius 100.
TourProblem circle(std::size_t count) {
  TourProblem problem{.travel = std::vector<std::vector<double>>(count, std::vector<double>(count, 0.0))};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const double angle =
          std::numbers::pi * (static_cast<double>(i) - static_cast<double>(j)) / static_cast<double>(count);
      problem.travel[i][j] = 200.0 * std::abs(std::sin(angle));
    }
  }
  return problem;
}

/// The slow, obvious version: the soonest end over all orders that keep windows, priorities and ends; infinite if there
/// is none.
double soonest_slowly(const TourProblem& problem) {
  const std::size_t count = problem.travel.size();
  const std::vector<TourProblem::Station> stations =
      problem.stations.empty() ? std::vector<TourProblem::Station>(count) : problem.stations;
  const bool is_round = problem.start && problem.start == problem.end;
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  double soonest = kInfinite;
  do {
    if ((problem.start && order.front() != *problem.start) ||
        (problem.end && !is_round && order.back() != *problem.end))
      continue;
    double now = 0.0;
    bool is_kept = true;
    std::vector<int> priorities;
    for (std::size_t k = 0; k < count; ++k) {
      if (k > 0) now += problem.travel[order[k - 1]][order[k]];
      now = std::max(now, stations[order[k]].earliest);
      is_kept &= now <= stations[order[k]].latest + kExactTol;
      now += stations[order[k]].service;
      if (problem.start != order[k] && problem.end != order[k]) priorities.push_back(stations[order[k]].priority);
    }
    if (is_round) now += problem.travel[order.back()][order.front()];
    if (is_kept && std::is_sorted(priorities.begin(), priorities.end())) soonest = std::min(soonest, now);
  } while (std::next_permutation(order.begin(), order.end()));
  return soonest;
}

/// Problem of seven stations: ends fixed or free, priorities, time windows, service times.
TourProblem constrained_problem(std::uint64_t seed) {
  const RandomStream stream(seed, "test/constraints");
  TourProblem problem = random_problem(seed, 7, seed % 2 == 0);
  if (seed % 3 != 0) problem.start = 2;
  if (seed % 5 == 0) problem.end = 5;
  if (seed % 7 == 0) problem.start = problem.end = 4;
  problem.stations.resize(7);
  for (std::size_t i = 0; i < 7; ++i) {
    if (seed % 4 == 0) problem.stations[i].priority = static_cast<int>(3.0 * stream.uniform(0, i));
    if (seed % 4 == 1)
      problem.stations[i].earliest = 200.0 * stream.uniform(1, i),
      problem.stations[i].latest = problem.stations[i].earliest + 300.0;
    problem.stations[i].service = 20.0 * stream.uniform(2, i);
  }
  return problem;
}

TEST(TourOrder, ExactIsTheBestOfAllOrdersOfSevenStations) {
  int num_found = 0;
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    const TourProblem problem = constrained_problem(seed);
    const TourOrder order = solve_station_order(problem, {}, 1);
    const double expected = soonest_slowly(problem);
    ASSERT_EQ(order.is_exact, std::isfinite(expected)) << "seed " << seed;
    if (!order.is_exact) {
      ASSERT_GT(order.lateness, 0.0) << "seed " << seed;
      continue;
    }
    ++num_found;
    ASSERT_NEAR(order.completion, expected, kExactTol) << "seed " << seed;
    ASSERT_EQ(order.lateness, 0.0);
  }
  EXPECT_GT(num_found, 65);
}

TEST(TourOrder, LocalSearchFindsTheExactOrderOfTenStationsInNineteenOfTwenty) {
  int num_equal = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TourProblem problem = random_problem(seed, 10, seed % 2 == 0);
    const TourOrder exact = solve_station_order(problem, {}, 1),
                    searched = solve_station_order(problem, {.exact_stations = 0}, 1);
    ASSERT_TRUE(exact.is_exact);
    ASSERT_FALSE(searched.is_exact);
    ASSERT_GE(searched.completion, exact.completion - kExactTol);
    ASSERT_LE(searched.lower_bound, exact.completion + kExactTol) << "seed " << seed;
    num_equal += searched.completion < exact.completion + kExactTol;
  }
  EXPECT_GE(num_equal, 19);
}

// The polygon of 30 sides of 200 sin(6 deg), and it is its own proof: the bound meets it.
TEST(TourOrder, RoundACircleOfThirtyIsThePolygonAndTheBoundSaysSo) {
  TourProblem problem = circle(30);
  problem.start = problem.end = 7;
  const TourOrder order = solve_station_order(problem, {}, 1);
  const double polygon = 30.0 * 200.0 * std::sin(std::numbers::pi / 30.0);
  EXPECT_NEAR(order.completion, polygon, 1e-6);
  EXPECT_EQ(order.stations.front(), 7u);
  EXPECT_LT(order.gap(), 1e-6);
}

// Without an end, all but one of its sides.
TEST(TourOrder, AlongACircleLeavesOutOneSide) {
  const TourOrder order = solve_station_order(circle(30), {}, 1);
  EXPECT_NEAR(order.completion, 29.0 * 200.0 * std::sin(std::numbers::pi / 30.0), 1e-6);
  EXPECT_LT(order.gap(), 0.01);
}

TEST(TourOrder, RoundFortyRandomStationsIsWithinFivePercentOfItsBound) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    TourProblem problem = random_problem(seed, 40);
    problem.start = problem.end = 0;
    const TourOrder order = solve_station_order(problem, {}, 1);
    EXPECT_TRUE(order.is_found);
    EXPECT_FALSE(order.is_exact);
    EXPECT_LE(order.gap(), 0.05) << "seed " << seed;
    EXPECT_GE(order.gap(), 0.0);
  }
}

TEST(TourOrder, LocalSearchKeepsWindowsPrioritiesAndEndsOfTwentyStations) {
  TourProblem problem = random_problem(3, 20);
  problem.start = 4, problem.end = 9;
  problem.stations.resize(20);
  for (std::size_t i = 0; i < 20; ++i) problem.stations[i].priority = i % 2 == 0 ? 1 : 2;
  problem.stations[6].earliest = 150.0;
  problem.stations[8].latest = 200.0;
  const TourOrder order = solve_station_order(problem, {}, 1);
  ASSERT_TRUE(order.is_found);
  EXPECT_EQ(order.lateness, 0.0);
  EXPECT_EQ(order.stations.front(), 4u);
  EXPECT_EQ(order.stations.back(), 9u);
  for (std::size_t k = 2; k + 1 < 20; ++k)
    EXPECT_LE(problem.stations[order.stations[k - 1]].priority, problem.stations[order.stations[k]].priority);
}

// There and back between two stations that lie one-way 3 and 5 apart.
TEST(TourOrder, OfOneAndTwoStationsIsPlain) {
  EXPECT_EQ(solve_station_order({.travel = {{0.0}}}, {}, 1).completion, 0.0);
  const TourOrder round = solve_station_order({.travel = {{0.0, 3.0}, {5.0, 0.0}}, .start = 1, .end = 1}, {}, 1);
  EXPECT_EQ(round.completion, 8.0);
  EXPECT_EQ(round.stations, (std::vector<std::size_t>{1, 0}));
  EXPECT_EQ(solve_station_order({.travel = {{0.0, 3.0}, {5.0, 0.0}}}, {}, 1).completion, 3.0);
}

TEST(TourOrder, SaysThatAStationCannotBeReached) {
  const TourOrder order = solve_station_order(
      {.travel = {{0.0, 1.0, kInfinite}, {1.0, 0.0, kInfinite}, {kInfinite, kInfinite, 0.0}}}, {}, 1);
  EXPECT_FALSE(order.is_found);
  EXPECT_EQ(order.stations.size(), 3u);
}

TEST(TourOrder, IsTheSameForTheSameSeed) {
  const TourProblem problem = random_problem(5, 18);
  EXPECT_EQ(solve_station_order(problem, {.restarts = 3}, 4).stations,
            solve_station_order(problem, {.restarts = 3}, 4).stations);
}

TEST(TourOrder, RefusesWhatIsNoProblem) {
  using ::testing::HasSubstr, ::testing::ThrowsMessage;
  const auto error_text = [](const TourProblem& problem) { return [problem] { solve_station_order(problem, {}, 1); }; };
  EXPECT_THAT(error_text({}), ThrowsMessage<InputError>(HasSubstr("no stations")));
  EXPECT_THAT(error_text({.travel = {{0.0, 1.0}, {1.0}}}),
              ThrowsMessage<InputError>(HasSubstr("row 1 of travel has 1 values")));
  EXPECT_THAT(error_text({.travel = {{0.0, -1.0}, {1.0, 0.0}}}),
              ThrowsMessage<InputError>(HasSubstr("travel from 0 to 1 is -1")));
  EXPECT_THAT(error_text({.travel = {{0.0}}, .stations = {{}, {}}}),
              ThrowsMessage<InputError>(HasSubstr("2 station descriptions: must be 1")));
  EXPECT_THAT(error_text({.travel = {{0.0}}, .stations = {{.earliest = 5.0, .latest = 4.0}}}),
              ThrowsMessage<InputError>(HasSubstr("station 0 has service 0 and window [5, 4]")));
  EXPECT_THAT(error_text({.travel = {{0.0}}, .start = 1}),
              ThrowsMessage<InputError>(HasSubstr("unknown station 1: must be in [0, 0]")));
}

}  // namespace
}  // namespace patrol::plan::tour_order_test
