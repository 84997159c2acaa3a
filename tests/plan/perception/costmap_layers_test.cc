#include <gtest/gtest.h>

#include "plan/perception/inflation_layer.h"
#include "plan/perception/keep_out_layer.h"
#include "plan/perception/scan_layer.h"
#include "plan/perception/static_map_layer.h"
#include "tests/support/room_world.h"

namespace patrol::plan::costmap_layers_test {
namespace {

/// Ten by eight cells of 0.1 m from the map's origin on.
const CellLattice kLattice(0.1, {0, 0}, {10, 8});
/// The lattice, grown on all sides.
const CellLattice kGrown(0.1, {-5, -3}, {20, 16});

OccupancyGrid make_map(Cell obstacle) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 10, .height = 8}, kFree);
  map.at(obstacle) = kOccupied;
  return map;
}

TEST(CellLattice, LatticeCellsStayTheSameWhenTheGridGrows) {
  const Cell lattice = kLattice.to_lattice({2, 3});
  EXPECT_EQ(kGrown.to_grid(lattice), (Cell{7, 6}));
  EXPECT_TRUE(kGrown.geometry.center_of({7, 6}).isApprox(kLattice.geometry.center_of({2, 3})));
}

TEST(StaticMapLayer, ChangesAreTheBoxOfTheCellsThatDiffer) {
  StaticMapLayer layer({});
  layer.resize(kLattice);
  const CellBox all = layer.set_map(make_map({4, 5}));
  EXPECT_EQ(all.min, (Cell{0, 0}));
  EXPECT_EQ(all.max, (Cell{9, 7}));
  EXPECT_TRUE(layer.set_map(make_map({4, 5})).is_empty());
  const CellBox moved = layer.set_map(make_map({6, 2}));
  EXPECT_EQ(moved.min, (Cell{4, 2}));
  EXPECT_EQ(moved.max, (Cell{6, 5}));
}

TEST(StaticMapLayer, GrowsWithItsObstaclesAndUnknownGroundAround) {
  StaticMapLayer layer({.unknown_cost = 0.5});
  layer.resize(kLattice);
  layer.set_map(make_map({4, 5}));
  layer.resize(kGrown);
  EXPECT_TRUE(layer.is_obstacle({9, 8}));
  EXPECT_TRUE(layer.has_obstacle_near({7, 10}, 2));
  EXPECT_FALSE(layer.has_obstacle_near({6, 10}, 2));
  Cost cost[] = {7, 7};
  layer.raise_costs({4, 8}, 2, cost);  // outside the map, and its first cell
  EXPECT_EQ(cost[0], kMaxPassableCost / 2);
  EXPECT_EQ(cost[1], 7);
}

TEST(ScanLayer, LeavesHitsOnTheMapsObstaclesToTheMap) {
  const LevelScan scan = test::RoomWorld().add_post(0.45, 0.55, 0.02).scan({0.1, 0.1, 0.0}, {.beams = 720});
  StaticMapLayer empty({}), map({});
  empty.resize(kLattice);
  map.resize(kLattice);
  map.set_map(make_map({4, 5}));
  ScanLayer with({}), without({});
  with.resize(kLattice);
  without.resize(kLattice);
  EXPECT_TRUE(with.add_scan(scan, {0.1, 0.1, 0.0}, map).is_empty());
  EXPECT_FALSE(without.add_scan(scan, {0.1, 0.1, 0.0}, empty).is_empty());
  EXPECT_TRUE(without.is_obstacle({4, 5}));
  without.resize(kGrown);
  EXPECT_TRUE(without.contains_obstacle({9, 8}));
  EXPECT_FALSE(without.contains_obstacle({-1, 0}));
  without.clear({0.45, 0.55}, 0.3);
  EXPECT_EQ(without.num_obstacles(), 0U);
}

TEST(InflationLayer, CostsFallWithTheDistanceToTheMarkedObstacles) {
  const CostmapSettings settings;
  InflationLayer layer(settings, Footprint({{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}));
  layer.resize(kLattice);
  CellBox changed;
  changed.extend({0, 4});
  const CellBox target = layer.update(changed, [](Cell first, int, std::uint8_t* is_obstacle) {
    if (first == Cell{0, 4}) is_obstacle[0] = 1;
  });
  EXPECT_EQ(target.max, (Cell{9, 7})) << "the cap reaches across the whole grid";
  Cost cost[10];
  layer.set_costs({0, 4}, 10, cost);
  EXPECT_EQ(cost[0], kLethalCost);
  for (int i = 1; i < 10; ++i) EXPECT_LE(cost[i], cost[i - 1]) << i;
  EXPECT_LT(cost[9], kMaxPassableCost / 10);
  EXPECT_NEAR(layer.distance_m(kLattice.geometry.center_of({5, 4})), 0.45, 1e-12);
}

TEST(KeepOutLayer, RaisesCostsNearItsLinesAndLowersNone) {
  KeepOutLayer layer({.keep_out_margin_m = 0.1, .keep_out_inflation_m = 0.2}, {{{0.5, -1.0}, {0.5, 2.0}}}, 1.0);
  layer.resize(kLattice);
  Cost cost[10] = {200, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  layer.raise_costs({0, 4}, 10, cost);
  EXPECT_EQ(cost[0], 200);
  EXPECT_EQ(cost[1], kFreeCost) << "0.35 m away";
  EXPECT_EQ(cost[4], kLethalCost);
  EXPECT_EQ(cost[5], kLethalCost);
  EXPECT_GT(cost[6], cost[7]);
  EXPECT_NEAR(layer.distance_m({0.85, 0.45}), 0.35, 1e-6);
}

}  // namespace
}  // namespace patrol::plan::costmap_layers_test
