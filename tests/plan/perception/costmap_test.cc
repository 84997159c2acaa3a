#include "plan/perception/costmap.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"
#include "tests/support/room_world.h"

namespace patrol::plan::costmap_test {
namespace {

using test::RoomWorld;
using test::VectorNear;

/// 0.8 by 0.4 m about the body's origin: inscribed radius 0.2 m.
Footprint make_robot() { return Footprint({{-0.4, -0.2}, {0.4, -0.2}, {0.4, 0.2}, {-0.4, 0.2}}); }

/// Known free ground, 10 m by 10 m about the origin.
OccupancyGrid make_free_map(double resolution_m = 0.1) {
  const int cells = static_cast<int>(std::lround(10.0 / resolution_m));
  return OccupancyGrid({.resolution_m = resolution_m, .width = cells, .height = cells, .origin_m = {-5.0, -5.0}},
                       kFree);
}

void occupy(OccupancyGrid& map, const Eigen::Vector2d& p) { map.at(map.geometry().cell_at(p)) = kOccupied; }

Costmap make_costmap(const OccupancyGrid& map, const CostmapSettings& settings = {}) {
  Costmap costmap(settings, make_robot(), {});
  costmap.set_map(map);
  return costmap;
}

/// A scan that sees along one beam only, which ends at `p_map`: all others are blocked, without echo, at the
/// robot's skin. The lidar stands at the body's origin.
LevelScan one_beam(const Pose2& T_map_body, const Eigen::Vector2d& p_map, double time_s, bool is_hit = true) {
  constexpr int kBeams = 1440;
  const Eigen::Vector2d end = T_map_body.inverse() * p_map;
  LevelScan scan;
  scan.stamp = from_seconds(time_s);
  for (int beam = 0; beam < kBeams; ++beam) {
    const double angle = 2.0 * std::numbers::pi * beam / kBeams;
    if (std::abs(wrap_angle(angle - std::atan2(end.y(), end.x()))) < 0.02) continue;
    scan.beams.push_back({(0.01 * Eigen::Vector2d(std::cos(angle), std::sin(angle))).cast<float>(), false});
  }
  scan.beams.push_back({end.cast<float>(), is_hit});
  return scan;
}

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

TEST(Costmap, WhatTheMapHasIsNoLiveObstacle) {
  OccupancyGrid map = make_free_map();
  occupy(map, {2.05, 0.05});
  Costmap costmap = make_costmap(map);
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 0.0), {});
  EXPECT_EQ(costmap.num_scan_obstacles(), 0u);
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kLethalCost);
}

TEST(Costmap, ALiveObstacleThatTheMapLearnsIsTheMapsFromThenOn) {
  Costmap costmap = make_costmap(make_free_map());
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 0.0), {});
  OccupancyGrid map = make_free_map();
  occupy(map, {2.05, 0.05});
  costmap.set_map(map);
  costmap.add_scan(one_beam({}, {-3.05, 0.05}, 0.1), {});
  EXPECT_FALSE(costmap.is_scan_obstacle(costmap.geometry().cell_at({2.05, 0.05})));
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kLethalCost);
  costmap.set_map(make_free_map());  // and leaves with it
  EXPECT_EQ(costmap.cost_at({2.05, 0.05}), kFreeCost);
}

TEST(Costmap, ForgettingLeavesLiveObstaclesOutsideTheCircle) {
  Costmap costmap = make_costmap(make_free_map());
  costmap.add_scan(one_beam({}, {1.55, 0.05}, 0.0), {});
  costmap.add_scan(one_beam({}, {0.05, 3.05}, 0.1), {});
  costmap.clear_obstacles({0.0, 0.0}, 2.0);
  EXPECT_EQ(costmap.num_scan_obstacles(), 1u);
  EXPECT_EQ(costmap.cost_at({1.55, 0.05}), kFreeCost);
  EXPECT_EQ(costmap.cost_at({0.05, 3.05}), kLethalCost);
}

// Refreshing only the surroundings of each change must end where working everything out afresh ends.
TEST(Costmap, RefreshedPieceByPieceEqualsAFreshOne) {
  OccupancyGrid map = make_free_map();
  const RandomStream stream(9, "test/obstacles");
  for (std::uint64_t i = 0; i < 30; ++i)
    occupy(map, {9.8 * stream.uniform(i, 0) - 4.9, 9.8 * stream.uniform(i, 1) - 4.9});
  Costmap piecewise = make_costmap(map);
  OccupancyGrid both = map;
  for (std::uint64_t i = 0; i < 20; ++i) {
    const Eigen::Vector2d p(6.0 * stream.uniform(i, 2) - 3.0, 6.0 * stream.uniform(i, 3) - 3.0);
    piecewise.add_scan(one_beam({}, p, 0.01 * static_cast<double>(i)), {});
  }
  for (int row = 0; row < both.geometry().height; ++row) {
    for (int col = 0; col < both.geometry().width; ++col) {
      const Eigen::Vector2d p = both.geometry().center_of({col, row});
      if (piecewise.is_scan_obstacle(piecewise.geometry().cell_at(p))) both.at({col, row}) = kOccupied;
    }
  }
  EXPECT_GT(piecewise.num_scan_obstacles(), 5u);
  const Costmap fresh = make_costmap(both);
  for (double x = -4.95; x < 5.0; x += 0.1) {
    for (double y = -4.95; y < 5.0; y += 0.1)
      ASSERT_EQ(piecewise.cost_at({x, y}), fresh.cost_at({x, y})) << x << ' ' << y;
  }
}

// A line along x: lethal within 0.2 m of it, then falling to e^-3 over the next 0.3 m.
TEST(Costmap, KeepOutLinesAreLethalAlongTheirWholeLength) {
  const CostmapSettings settings{.unknown_cost = 0.0, .keep_out_margin_m = 0.2, .keep_out_inflation_m = 0.3};
  const Costmap costmap(settings, make_robot(), {{{-3.0, 0.0}, {3.0, 0.0}}});
  for (double x = -2.95; x < 3.0; x += 0.1) {
    EXPECT_EQ(costmap.cost_at({x, 0.15}), kLethalCost);
    EXPECT_EQ(costmap.cost_at({x, -0.15}), kLethalCost);
    EXPECT_EQ(costmap.cost_at({x, 0.25}), std::lround(252.0 * std::exp(-0.05 / 0.1)));
    EXPECT_EQ(costmap.cost_at({x, 0.55}), kFreeCost);
  }
  EXPECT_EQ(costmap.cost_at({3.55, 0.05}), kFreeCost);  // past its end
}

TEST(Costmap, KeepOutDistanceIsTheDistanceToTheLine) {
  const Costmap costmap({}, make_robot(), {{{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}}});
  EXPECT_NEAR(costmap.keep_out_distance_m({1.0, -0.5}), 0.5, 1e-3);
  EXPECT_NEAR(costmap.keep_out_distance_m({2.4, 1.23}), 0.4, 1e-3);
  EXPECT_NEAR(costmap.keep_out_distance_m({-0.3, -0.4}), 0.5, 5e-3);  // from the corner
  EXPECT_GE(costmap.keep_out_distance_m({-4.0, -4.0}), costmap.max_distance_m());
}

TEST(Costmap, NoRouteLeadsBetweenCellsAcrossAKeepOutLine) {
  // Slanted, so that the line crosses cells at every place: each cell it touches must be lethal.
  const Polyline line{{-2.0, -1.37}, {2.0, 1.11}};
  const Costmap costmap({}, make_robot(), {line});
  for (double fraction = 0.0; fraction <= 1.0; fraction += 0.001) {
    ASSERT_EQ(costmap.cost_at(line[0] + fraction * (line[1] - line[0])), kLethalCost) << fraction;
  }
}

TEST(Costmap, GrowingKeepsMapLiveObstaclesAndLines) {
  OccupancyGrid map = make_free_map();
  occupy(map, {-3.05, 2.05});
  Costmap costmap({}, make_robot(), {{{-1.0, -3.0}, {1.0, -3.0}}});
  costmap.set_map(map);
  costmap.add_scan(one_beam({}, {2.05, 0.05}, 0.0), {});
  const Costmap before = costmap;
  const std::size_t size_before = costmap.geometry().size();
  costmap.include({-30.0, 12.0}, 1.0);
  costmap.include({25.0, -40.0}, 1.0);
  EXPECT_GT(costmap.geometry().size(), size_before);
  for (double x = -4.95; x < 5.0; x += 0.1) {
    for (double y = -4.95; y < 5.0; y += 0.1)
      ASSERT_EQ(costmap.cost_at({x, y}), before.cost_at({x, y})) << x << ' ' << y;
  }
  EXPECT_EQ(costmap.num_scan_obstacles(), 1u);
  EXPECT_TRUE(costmap.is_scan_obstacle(costmap.geometry().cell_at({2.05, 0.05})));
  EXPECT_EQ(costmap.cost_at({25.0, -40.0}), 38);  // unknown: 0.15 x 252
}

TEST(Costmap, GrowingNeverMovesTheCells) {
  Costmap costmap({}, make_robot(), {});
  costmap.include({17.3, -8.8}, 3.3);
  const Eigen::Vector2d cells = costmap.geometry().origin_m / 0.1;
  EXPECT_NEAR(cells.x(), std::round(cells.x()), 1e-9);
  EXPECT_NEAR(cells.y(), std::round(cells.y()), 1e-9);
}

// A wall's cells are centred at x = 2.05, its surface at 2.0: from the origin 2 m, cut off at the field's
// reach.
TEST(Costmap, ObstacleDistanceToAWallIsExactToTwoCentimetres) {
  OccupancyGrid map = make_free_map();
  for (double y = -4.95; y < 5.0; y += 0.1) occupy(map, {2.05, y});
  const Costmap costmap = make_costmap(map);
  for (double x = 1.2; x < 1.9; x += 0.01) EXPECT_NEAR(costmap.obstacle_distance_m({x, 0.3}), 2.0 - x, 0.02) << x;
  EXPECT_NEAR(costmap.obstacle_distance_m({-3.0, 0.0}), costmap.max_distance_m(), 1e-12);
}

// The robot 0.8 m long, 0.4 m wide, beside a wall whose surface lies 0.5 m to its left: 0.5 - 0.2 m to its
// side, less the margin. Its discs stick out by up to 0.03 m.
TEST(Costmap, ClearanceIsTheGapBesideTheOutlineLessTheMargin) {
  OccupancyGrid map = make_free_map();
  for (double x = -4.95; x < 5.0; x += 0.1) occupy(map, {x, 0.55});
  const Costmap costmap = make_costmap(map, {.safety_margin_m = 0.05});
  const double beside = costmap.clearance_m({0.0, 0.0, 0.0});
  EXPECT_LE(beside, 0.5 - 0.2 - 0.05 + 0.01);
  EXPECT_GE(beside, 0.5 - 0.2 - 0.05 - 0.04);
  EXPECT_LT(costmap.clearance_m({0.0, 0.0, std::numbers::pi / 2.0}), 0.1);  // its nose 0.1 m before the wall
  EXPECT_LT(costmap.clearance_m({0.0, 0.35, 0.0}), 0.0);                    // its side 5 cm in it
}

TEST(Costmap, ClearanceOverAKeepOutLineIsNegative) {
  const Costmap costmap({.keep_out_margin_m = 0.2}, make_robot(), {{{-2.0, 1.0}, {2.0, 1.0}}});
  EXPECT_LT(costmap.clearance_m({0.0, 0.9, 0.0}), 0.0);
  EXPECT_NEAR(costmap.clearance_m({0.0, 0.5, 0.0}), 0.5 - 0.2, 0.01);
}

// Wherever clearance is positive, the outline itself, margin aside, must be free of every obstacle cell's
// centre.
TEST(Costmap, ClearanceNeverSaysFreeWhereTheOutlineTouches) {
  const Footprint robot = make_robot();
  int num_free = 0, num_blocked = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream stream(seed, "test/obstacles");
    OccupancyGrid map = make_free_map();
    std::vector<Eigen::Vector2d> centers;
    for (std::uint64_t i = 0; i < 60; ++i) {
      const Eigen::Vector2d p(9.8 * stream.uniform(i, 0) - 4.9, 9.8 * stream.uniform(i, 1) - 4.9);
      occupy(map, p);
      centers.push_back(map.geometry().center_of(map.geometry().cell_at(p)));
    }
    const Costmap costmap = make_costmap(map);
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Pose2 pose{8.0 * stream.uniform(i, 2) - 4.0, 8.0 * stream.uniform(i, 3) - 4.0, 6.28 * stream.uniform(i, 4)};
      bool touches = false;
      for (const Eigen::Vector2d& center : centers) {
        const Eigen::Vector2d p = pose.inverse() * center;
        touches = touches || (std::abs(p.x()) <= 0.4 && std::abs(p.y()) <= 0.2);
      }
      const bool is_free = costmap.clearance_m(pose) > 0.0;
      ASSERT_FALSE(is_free && touches) << "seed " << seed << " pose " << pose.vector().transpose();
      ++(is_free ? num_free : num_blocked);
    }
  }
  EXPECT_GT(num_free, 1000);
  EXPECT_GT(num_blocked, 1000);
}

TEST(Costmap, RefusesSettingsThatBreakTheirRule) {
  EXPECT_THAT([] { Costmap({.resolution_m = 0.0}, make_robot(), {}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("costmap.resolution_m = 0")));
}

// The field reaches 100 cells: 2 m. What lies farther would be taken for free.
TEST(Costmap, RefusesAnOutlineThatReachesBeyondItsField) {
  CostmapSettings settings;
  settings.resolution_m = 0.02;
  const auto square = [](double half_m) {
    return Footprint({{half_m, half_m}, {-half_m, half_m}, {-half_m, -half_m}, {half_m, -half_m}});
  };
  EXPECT_NO_THROW(Costmap(settings, square(1.5), {}));
  EXPECT_THAT([&] { Costmap(settings, square(2.5), {}); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("exceed the costmap's range of 1.98 m")));
}

}  // namespace
}  // namespace patrol::plan::costmap_test
