#include "plan/perception/costmap.h"

#include <limits>
#include <string>

#include "core/error.h"
#include "tests/plan/perception/costmap_parts.h"

namespace patrol::plan::costmap_test {
namespace {

// An obstacle's surface lies, for all we know, half a cell before its centre. Lethal within 0.2 m (inscribed)
// + 0.06 m (margin), then 252 exp(-(distance - 0.26) / decay), nothing beyond the inflation radius.
TEST(Costmap, InflationFallsExponentiallyFromTheLethalDistance) {
  const CostmapSettings settings{.inflation_radius_m = 0.8, .inflation_decay_m = 0.3, .safety_margin_m = 0.06};
  OccupancyGrid map = make_free_map();
  occupy(map, {0.05, 0.05});
  const Costmap costmap = make_costmap(map, settings);
  for (int col = -12; col <= 12; ++col) {
    for (int row = -12; row <= 12; ++row) {
      const double surface_m = std::max(0.0, 0.1 * std::hypot(col, row) - 0.05);
      const double decayed = kMaxPassableCost * std::exp(-(surface_m - 0.26) / 0.3);
      const double expected = surface_m <= 0.26 ? kLethalCost : surface_m <= 0.8 ? std::round(decayed) : kFreeCost;
      EXPECT_EQ(costmap.cost_at({0.05 + 0.1 * col, 0.05 + 0.1 * row}), expected) << col << ' ' << row;
    }
  }
}

TEST(Costmap, CellsFromTheOccupiedPercentOnAreObstacles) {
  OccupancyGrid map = make_free_map();
  map.at(map.geometry().cell_at({2.05, 0.05})) = 64;
  map.at(map.geometry().cell_at({-2.05, 0.05})) = 65;
  const Costmap costmap = make_costmap(map, {.occupied_percent = 65});
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kFreeCost);
  EXPECT_EQ(costmap.cost_at({-2.05, 0.05}), kLethalCost);
}

TEST(Costmap, UnknownGroundCostsItsShare) {
  const Costmap costmap({.unknown_cost = 0.25}, make_robot(), {});
  EXPECT_EQ(costmap.cost_at({1.0, 1.0}), 63);    // 0.25 x 252
  EXPECT_EQ(costmap.cost_at({900.0, 1.0}), 63);  // outside
  const Costmap known = make_costmap(make_free_map(), {.unknown_cost = 0.25});
  EXPECT_EQ(known.cost_at({1.0, 1.0}), kFreeCost);
}

TEST(Costmap, UnknownGroundIsNoWayForARobotThatKeepsToItsMap) {
  OccupancyGrid map = make_free_map();
  map.at(map.geometry().cell_at({2.05, 0.05})) = kUnknown;
  const Costmap costmap = make_costmap(map, {.allow_unknown = false});
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kLethalCost);
  EXPECT_EQ(costmap.cost_at({2.15, 0.05}), kFreeCost) << "it is no obstacle: nothing is kept from it";
  EXPECT_EQ(costmap.cost_at({900.0, 1.0}), kLethalCost) << "outside";
}

/// Message of the refusal of an empty scan from a pose; empty if it is accepted.
std::string refusal_of_scan_from(const Pose2& T_map_body) {
  Costmap costmap = make_costmap(make_free_map());
  const std::size_t cells = costmap.geometry().size();
  try {
    costmap.add_scan(LevelScan{}, T_map_body);
  } catch (const InputError& error) {
    EXPECT_EQ(costmap.geometry().size(), cells);
    return error.what();
  }
  return "";
}

TEST(Costmap, PosesThatAreNotFiniteOrBeyond100KilometersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal_of_scan_from({nan, 1.0, 0.0}), "costmap: position (nan, 1) m: must be finite and within 100000 m");
  EXPECT_EQ(refusal_of_scan_from({0.0, -infinity, 0.0}),
            "costmap: position (0, -inf) m: must be finite and within 100000 m");
  EXPECT_EQ(refusal_of_scan_from({1.1e5, 0.0, 0.0}),
            "costmap: position (110000, 0) m: must be finite and within 100000 m");
  EXPECT_EQ(refusal_of_scan_from({1.0, 2.0, nan}), "costmap: yaw nan rad: must be finite");
  EXPECT_EQ(refusal_of_scan_from({50.0, -40.0, 3.0}), "");
}

TEST(Costmap, AFinerMapLosesNoObstacle) {
  OccupancyGrid map = make_free_map(0.025);
  const RandomStream stream(4, "test/obstacles");
  std::vector<Eigen::Vector2d> places;
  for (std::uint64_t i = 0; i < 50; ++i) {
    places.emplace_back(9.9 * stream.uniform(i, 0) - 4.95, 9.9 * stream.uniform(i, 1) - 4.95);
    occupy(map, places.back());
  }
  const Costmap costmap = make_costmap(map);
  for (const Eigen::Vector2d& p : places) EXPECT_EQ(costmap.cost_at(p), kLethalCost);
}

TEST(Costmap, RefusesAMapCoarserThanItself) {
  Costmap costmap({.resolution_m = 0.1}, make_robot(), {});
  EXPECT_THAT([&] { costmap.set_map(make_free_map(0.2)); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("costmap.resolution_m = 0.1")));
}

TEST(Costmap, ABlockedCellThatTheMapFreesIsFreeAgain) {
  OccupancyGrid map = make_free_map();
  occupy(map, {1.05, 1.05});
  Costmap costmap = make_costmap(map);
  costmap.set_map(make_free_map());
  for (const Cost cost : costmap.cost().values()) ASSERT_TRUE(cost == kFreeCost || cost == 38);  // 0.15 x 252: unknown
  EXPECT_EQ(costmap.cost_at({1.05, 1.05}), kFreeCost);
}

TEST(Costmap, ALiveHitIsLethalAndGoesWhenABeamPasses) {
  Costmap costmap = make_costmap(make_free_map());
  const Pose2 T_map_body{0.5, -0.5, 0.7};
  costmap.add_scan(one_beam(T_map_body, {2.05, 0.55}, 0.0), T_map_body);
  EXPECT_EQ(costmap.num_scan_obstacles(), 1u);
  EXPECT_EQ(costmap.cost_at({2.05, 0.55}), kLethalCost);
  // A beam through that place to one a metre beyond.
  const Eigen::Vector2d along = Eigen::Vector2d(2.05, 0.55) - T_map_body.position();
  const Eigen::Vector2d beyond = T_map_body.position() + (1.0 + 1.0 / along.norm()) * along;
  costmap.add_scan(one_beam(T_map_body, beyond, 0.1, false), T_map_body);
  EXPECT_EQ(costmap.num_scan_obstacles(), 0u);
  for (const Cost cost : costmap.cost().values()) ASSERT_NE(cost, kLethalCost);
}

TEST(Costmap, ABeamThatStopsShortLeavesWhatIsBehindIt) {
  Costmap costmap = make_costmap(make_free_map());
  costmap.add_scan(one_beam({}, {3.05, 0.05}, 0.0), {});
  costmap.add_scan(one_beam({}, {1.55, 0.026}, 0.1), {});
  EXPECT_EQ(costmap.cost_at({3.05, 0.05}), kLethalCost);
  EXPECT_EQ(costmap.num_scan_obstacles(), 2u);
}

TEST(Costmap, ABeamElsewhereLeavesALiveObstacle) {
  Costmap costmap = make_costmap(make_free_map());
  const RandomStream no_noise(0, "none");
  RoomWorld room;
  room.add_post(2.0, 0.0, 0.15);
  const RoomWorld::ScanOptions options{.beams = 720};
  costmap.add_scan(room.scan({}, options), {});
  const std::size_t seen = costmap.num_scan_obstacles();
  EXPECT_GT(seen, 2u);
  costmap.add_scan(room.scan({}, options), {});  // again: nothing changes
  EXPECT_EQ(costmap.num_scan_obstacles(), seen);
}

TEST(Costmap, APersonWalkingAcrossLeavesNothingBehind) {
  Costmap costmap = make_costmap(make_free_map());
  for (int step = 0; step <= 60; ++step) {
    RoomWorld person;
    person.add_post(2.0, -3.0 + 0.1 * step, 0.2);
    LevelScan scan = person.scan({}, {.beams = 1440});
    scan.stamp = from_seconds(0.1 * step);
    costmap.add_scan(scan, {});
  }
  RoomWorld nobody;
  costmap.add_scan(nobody.scan({}, {.beams = 1440}), {});
  EXPECT_EQ(costmap.num_scan_obstacles(), 0u);
}

TEST(Costmap, WhatIsNotSeenAgainIsForgottenAfterItsMemory) {
  Costmap costmap = make_costmap(make_free_map(), {.obstacle_persistence_s = 5.0});
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 1.0), {});
  costmap.add_scan(one_beam({}, {-3.05, 0.05}, 5.9), {});  // looks elsewhere, 4.9 s later
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kLethalCost);
  costmap.add_scan(one_beam({}, {-3.05, 0.05}, 6.1), {});  // 5.1 s later
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kFreeCost);
  EXPECT_EQ(costmap.cost_at({-3.05, 0.05}), kLethalCost);
}

// Of three, the first goes; the last, seen again at 4 s, must be believed until 9 s.
TEST(Costmap, AfterOneIsForgottenTheOthersAreStillThemselves) {
  Costmap costmap = make_costmap(make_free_map(), {.obstacle_persistence_s = 5.0});
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 0.0), {});
  costmap.add_scan(one_beam({}, {0.05, 2.05}, 0.1), {});
  costmap.add_scan(one_beam({}, {-2.05, 0.05}, 0.2), {});
  costmap.add_scan(one_beam({}, {3.05, 0.0746}, 0.3, false), {});  // passes the first
  EXPECT_EQ(costmap.num_scan_obstacles(), 2u);
  costmap.add_scan(one_beam({}, {-2.05, 0.05}, 4.0), {});
  costmap.add_scan(one_beam({}, {0.05, -3.05}, 8.9), {});
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kFreeCost);
  EXPECT_EQ(costmap.cost_at({0.05, 2.05}), kFreeCost);
  EXPECT_EQ(costmap.cost_at({-2.05, 0.05}), kLethalCost);
}

TEST(Costmap, HitsBeyondTheObstacleRangeAreLeftToTheMap) {
  Costmap costmap = make_costmap(make_free_map(), {.obstacle_range_m = 3.0});
  costmap.add_scan(one_beam({}, {3.2, 0.05}, 0.0), {});
  EXPECT_EQ(costmap.num_scan_obstacles(), 0u);
  costmap.add_scan(one_beam({}, {2.8, 0.05}, 0.1), {});
  EXPECT_EQ(costmap.num_scan_obstacles(), 1u);
}

// The map's wall is at x = 2; noise puts hits one cell before it.
TEST(Costmap, WithSlackAHitBesideTheMapsObstacleIsThatObstacle) {
  OccupancyGrid map = make_free_map();
  occupy(map, {2.05, 0.05});
  Costmap strict = make_costmap(map), slack = make_costmap(map, {.map_match_tolerance_cells = 1});
  for (Costmap* costmap : {&strict, &slack}) {
    costmap->add_scan(one_beam({}, {1.95, 0.05}, 0.0), {});
    costmap->add_scan(one_beam({}, {0.05, 1.85}, 0.1), {});
  }
  EXPECT_EQ(strict.num_scan_obstacles(), 2u);
  EXPECT_EQ(slack.num_scan_obstacles(), 1u);
}

TEST(Costmap, KnowsSinceWhenALiveObstacleStands) {
  Costmap costmap = make_costmap(make_free_map());
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 1.0), {});
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 3.0), {});
  costmap.add_scan(one_beam({}, {0.05, 2.05}, 4.0), {});
  EXPECT_EQ(costmap.obstacle_first_seen({2.2, 0.1}, 0.3), from_seconds(1.0));
  EXPECT_EQ(costmap.obstacle_first_seen({0.05, 2.05}, 0.3), from_seconds(4.0));
  EXPECT_FALSE(costmap.obstacle_first_seen({-2.0, 0.0}, 0.3));
}

TEST(Costmap, RoutesKeepTheirMarginBeyondTheOutlines) {
  OccupancyGrid map = make_free_map();
  occupy(map, {0.05, 0.05});
  const Costmap costmap = make_costmap(map, {.safety_margin_m = 0.05, .route_margin_m = 0.1});
  EXPECT_EQ(costmap.cost_at({0.45, 0.05}), kLethalCost);  // its surface is 0.35 m away, 0.2 + 0.05 + 0.1
  EXPECT_NE(costmap.cost_at({0.55, 0.05}), kLethalCost);
  EXPECT_EQ(make_costmap(map, {.safety_margin_m = 0.05}).clearance_m({0.65, 0.05, 1.57}),
            costmap.clearance_m({0.65, 0.05, 1.57}));
}

TEST(Costmap, IsClearWhereTheClearanceExceedsTheMarginToOneCell) {
  OccupancyGrid map = make_free_map();
  const RandomStream stream(5, "test/clear");
  for (std::uint64_t i = 0; i < 12; ++i)
    occupy(map, {9.9 * stream.uniform(i, 0) - 4.95, 9.9 * stream.uniform(i, 1) - 4.95});
  const Costmap costmap = make_costmap(map, {.safety_margin_m = 0.05});
  int num_clear = 0, num_blocked = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Pose2 pose{9.0 * stream.uniform(i, 2) - 4.5, 9.0 * stream.uniform(i, 3) - 4.5, 6.3 * stream.uniform(i, 4)};
    const double clearance_m = costmap.clearance_m(pose), margin_m = 0.3 * stream.uniform(i, 5);
    ++(clearance_m > margin_m ? num_clear : num_blocked);
    if (std::abs(clearance_m - margin_m) < costmap.settings().resolution_m) continue;
    EXPECT_EQ(costmap.is_clear(pose, margin_m), clearance_m > margin_m) << clearance_m << ' ' << margin_m;
  }
  EXPECT_GT(num_clear, 200);
  EXPECT_GT(num_blocked, 200);
}

TEST(Costmap, WhatTheMapHasIsNoLiveObstacle) {
  OccupancyGrid map = make_free_map();
  occupy(map, {2.05, 0.05});
  Costmap costmap = make_costmap(map);
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 0.0), {});
  EXPECT_EQ(costmap.num_scan_obstacles(), 0u);
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kLethalCost);
}

}  // namespace
}  // namespace patrol::plan::costmap_test
