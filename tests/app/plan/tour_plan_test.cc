#include "app/plan/tour_plan.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/plan/routes/drawn_grid.h"

namespace patrol::app::tour_plan_test {
namespace {

using test::draw;
using ::testing::ElementsAre;

constexpr double kExactTol = 1e-9;

TourStop stop(double x_m, double y_m, io::TourStation station = {}) {
  return {.station = std::move(station), .p_m = {x_m, y_m}};
}

std::vector<std::size_t> places_of(const TourPlan& tour) {
  std::vector<std::size_t> nodes;
  for (const TourVisit& visit : tour.visits) nodes.push_back(visit.node);
  return nodes;
}

// Along a corridor of cells of 1 m from 0.5: stations at 8.5, 2.5 and 5.5.
const Grid<plan::Cost> kCorridor = draw({".........."});
const std::vector<TourStop> kThree = {stop(8.5, 0.5), stop(2.5, 0.5), stop(5.5, 0.5)};

TEST(TourPlan, ARoundAlongACorridorIsThereAndBack) {
  const std::optional<TourPlan> tour = plan_tour(kCorridor, {0.5, 0.5}, kThree, {}, PlanSettings());
  ASSERT_TRUE(tour->order.is_found);
  EXPECT_NEAR(tour->order.completion, 16.0, kExactTol);  // 8 m there and back at 1 m/s
  EXPECT_TRUE(tour->order.is_exact);
  EXPECT_EQ(tour->visits.front().node, 0u);
  EXPECT_EQ(tour->visits.back().node, 0u);
  EXPECT_EQ(tour->num_routes, 6);  // of 4 places
}

TEST(TourPlan, WithAnEndTheOrderIsByTheWayThereAtTheSpeed) {
  PlanSettings settings;
  settings.speed_mps = 0.5;
  const std::optional<TourPlan> tour = plan_tour(kCorridor, {0.5, 0.5}, kThree, Eigen::Vector2d(9.5, 0.5), settings);
  EXPECT_THAT(places_of(*tour), ElementsAre(0u, 2u, 3u, 1u, 4u));
  EXPECT_NEAR(tour->order.completion, 18.0, kExactTol);
  EXPECT_NEAR(tour->visits[1].arrives_s, 4.0, kExactTol);
  EXPECT_NEAR(test::length_of(tour->points_m), 9.0, kExactTol);
}

// At 5.5 from 7 s on, for 3 s; at 8.5 no later than 12 s, which it misses by 1 s: the priority is not to be broken.
TEST(TourPlan, TimesAreThoseOfWaitingServiceAndMissedWindows) {
  const std::vector<TourStop> stops = {stop(5.5, 0.5, {.service_s = 3.0, .earliest_s = 7.0}),
                                       stop(8.5, 0.5, {.latest_s = 12.0, .priority = 1})};
  const std::optional<TourPlan> tour = plan_tour(kCorridor, {0.5, 0.5}, stops, {}, PlanSettings());
  EXPECT_THAT(places_of(*tour), ElementsAre(0u, 1u, 2u, 0u));
  EXPECT_NEAR(tour->visits[1].arrives_s, 5.0, kExactTol);
  EXPECT_NEAR(tour->visits[1].waits_s, 2.0, kExactTol);
  EXPECT_NEAR(tour->visits[1].leaves_s, 10.0, kExactTol);
  EXPECT_NEAR(tour->visits[2].arrives_s, 13.0, kExactTol);
  EXPECT_NEAR(tour->visits[2].late_s, 1.0, kExactTol);
  EXPECT_NEAR(tour->order.lateness, 1.0, kExactTol);
  EXPECT_NEAR(tour->visits[3].arrives_s, tour->order.completion, kExactTol);
}

TEST(TourPlan, WhatCannotBeReachedIsLeftOutAndNamed) {
  const Grid<plan::Cost> costs = draw({"......#..."});
  const std::optional<TourPlan> tour =
      plan_tour(costs, {0.5, 0.5}, {stop(8.5, 0.5), stop(2.5, 0.5), stop(6.5, 0.5)}, {}, PlanSettings());
  EXPECT_THAT(tour->unreachable, ElementsAre(1u, 3u));
  EXPECT_THAT(places_of(*tour), ElementsAre(0u, 2u, 0u));
  const std::optional<TourPlan> none =
      plan_tour(costs, {0.5, 0.5}, {stop(2.5, 0.5)}, Eigen::Vector2d(9.5, 0.5), PlanSettings());
  EXPECT_THAT(none->unreachable, ElementsAre(2u));
  EXPECT_FALSE(none->order.is_found);
}

TEST(TourPlan, FromABlockedStartNothingIsReached) {
  const std::optional<TourPlan> tour = plan_tour(draw({"#..."}), {0.5, 0.5}, {stop(2.5, 0.5)}, {}, PlanSettings());
  EXPECT_THAT(tour->unreachable, ElementsAre(1u));
  EXPECT_FALSE(tour->order.is_found);
}

TEST(TourPlan, StationsInOneCellAndAtTheStartAreNoWayApart) {
  const std::optional<TourPlan> tour =
      plan_tour(kCorridor, {0.5, 0.5}, {stop(0.5, 0.5), stop(3.5, 0.5), stop(3.2, 0.2)}, {}, PlanSettings());
  ASSERT_TRUE(tour->order.is_found);
  EXPECT_NEAR(tour->order.completion, 6.0, kExactTol);
}

// The whole way is one piece: each leg begins where the one before ended, whichever way it was planned.
TEST(TourPlan, TheWholeWayIsOnePieceAndAsLongAsItsLegs) {
  const Grid<plan::Cost> costs = draw({"........", ".######.", ".#......", "...##.#.", "........"});
  const std::optional<TourPlan> tour = plan_tour(
      costs, {0.5, 0.5}, {stop(7.5, 4.5), stop(2.5, 2.5), stop(5.5, 0.5), stop(0.5, 4.5)}, {}, PlanSettings());
  ASSERT_TRUE(tour->order.is_found);
  double legs_m = 0.0;
  for (const TourVisit& visit : tour->visits) legs_m += visit.leg_m;
  EXPECT_NEAR(test::length_of(tour->points_m), legs_m, kExactTol);
  EXPECT_EQ(tour->points_m.front(), tour->points_m.back());
  EXPECT_TRUE(test::keeps_clear(costs, tour->points_m));
}

}  // namespace
}  // namespace patrol::app::tour_plan_test
