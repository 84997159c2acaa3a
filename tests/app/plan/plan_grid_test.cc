#include "app/plan/plan_grid.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::plan_grid_test {
namespace {

PlanSetup setup_of(const PlanOptions& options) { return load_plan_setup(options); }
PlanOptions disc(double radius_m, std::vector<std::string> overrides = {}) {
  return {.map = "m.yaml", .radius_m = radius_m, .overrides = std::move(overrides)};
}

/// 10 m x 10 m of free cells of 0.1 m, one of them, 5 m from either side, occupied.
OccupancyGrid one_post(const Eigen::Vector2d& origin_m) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 100, .height = 100, .origin_m = origin_m}, kFree);
  map.at({50, 50}) = kOccupied;
  return map;
}

TEST(PlanGrid, APointIsStoppedByOccupiedCellsAndByUnknownOnesAsItIsTold) {
  OccupancyGrid map({.resolution_m = 0.1, .width = 3, .height = 1}, kFree);
  map.at({1, 0}) = kUnknown;
  map.at({2, 0}) = kOccupied;
  const PlanSetup careful = setup_of({.map = "m.yaml"}),
                  bold = setup_of({.map = "m.yaml", .overrides = {"allow_unknown=true"}});
  EXPECT_EQ(make_costs(map, careful.body, careful.settings.costmap).values(), (std::vector<plan::Cost>{0, 255, 255}));
  EXPECT_EQ(make_costs(map, bold.body, bold.settings.costmap).values(), (std::vector<plan::Cost>{0, 0, 255}));
}

// The cell's surface counts as half a cell nearer than its centre, and costmap.safety_margin_m is 0.05 m: lethal are
// centres within 0.32 + 0.05 + 0.05 m; none lies just there.
TEST(PlanGrid, ADiscMakesLethalWhatLiesWithinItsRadiusAndTheMargin) {
  const PlanSetup setup = setup_of(disc(0.32));
  const Grid<plan::Cost> costs = make_costs(one_post({0.0, 0.0}), setup.body, setup.settings.costmap);
  ASSERT_EQ(costs.geometry().width, 100);
  for (int row = 0; row < 100; ++row) {
    for (int col = 0; col < 100; ++col) {
      const bool is_near = 0.1 * std::hypot(col - 50, row - 50) <= 0.42;
      EXPECT_EQ(costs.at({col, row}) == plan::kLethalCost, is_near) << col << ", " << row;
    }
  }
}

TEST(PlanGrid, AMapHundredsOfKilometresOffItsFramesOriginIsInflatedLikeAnyOther) {
  const PlanSetup setup = setup_of(disc(0.3));
  const Grid<plan::Cost> near = make_costs(one_post({0.0, 0.0}), setup.body, setup.settings.costmap);
  const Grid<plan::Cost> far = make_costs(one_post({500'000.0, -70'000.0}), setup.body, setup.settings.costmap);
  EXPECT_EQ(near.values(), far.values());
  EXPECT_NEAR(far.geometry().origin_m.x(), 500'000.0, 1e-6);
  EXPECT_NEAR(far.geometry().origin_m.y(), -70'000.0, 1e-6);
}

TEST(PlanGrid, CoversTheMapAndNothingBeyondWhereverItBegins) {
  const PlanSetup setup = setup_of(disc(0.1));
  OccupancyGrid map({.resolution_m = 0.05, .width = 33, .height = 7, .origin_m = {-1.03, 2.02}}, kFree);
  const Grid<plan::Cost> costs = make_costs(map, setup.body, setup.settings.costmap);
  for (const Cell corner : {Cell{0, 0}, Cell{32, 6}})
    EXPECT_TRUE(costs.contains(costs.geometry().cell_at(map.geometry().center_of(corner))));
  EXPECT_EQ(costs.geometry().width, 18);  // x from -1.1 to 0.7
  EXPECT_EQ(costs.geometry().height, 4);  // y from 2.0 to 2.4
}

TEST(PlanGrid, CellsAreNoFinerThanTheMaps) {
  const PlanSetup setup = setup_of(disc(0.5));
  OccupancyGrid map({.resolution_m = 0.4, .width = 10, .height = 10}, kFree);
  EXPECT_EQ(make_costs(map, setup.body, setup.settings.costmap).geometry().resolution_m, 0.4);
}

// Without inflation the distance field reaches 0.3 m beyond the outline, in whole cells of 0.1 m: 0.6 m here.
TEST(PlanGrid, AnOutlineBeyondTheCostmapsReachIsRefused) {
  const PlanSetup wide = setup_of(disc(9.9)),
                  margins = setup_of(disc(0.2, {"costmap.inflation_radius_m=0.05", "costmap.safety_margin_m=0.5"}));
  EXPECT_THROW(make_costs(one_post({0.0, 0.0}), wide.body, wide.settings.costmap), InputError);
  EXPECT_THROW(make_costs(one_post({0.0, 0.0}), margins.body, margins.settings.costmap), InputError);
}

TEST(PlanGrid, TheNearestFreeCellIsFoundHoweverFarOrNotAtAll) {
  Grid<plan::Cost> costs({.resolution_m = 1.0, .width = 60, .height = 1}, plan::kLethalCost);
  EXPECT_EQ(nearest_free(costs, {0.5, 0.5}), std::nullopt);
  costs.at({57, 0}) = 0;
  EXPECT_EQ(nearest_free(costs, {0.5, 0.5}), (Cell{57, 0}));
  costs.at({40, 0}) = 0;
  EXPECT_EQ(nearest_free(costs, {0.5, 0.5}), (Cell{40, 0}));
}

TEST(PlanGrid, SaysWhyNothingCanStandThere) {
  OccupancyGrid map({.resolution_m = 1.0, .width = 3, .height = 1}, kFree);
  map.at({1, 0}) = kUnknown;
  map.at({2, 0}) = kOccupied;
  const plan::CostmapSettings careful{.allow_unknown = false}, bold{.allow_unknown = true};
  EXPECT_STREQ(blocked_reason(map, careful, {0.5, 0.5}), "is too close to an obstacle");
  EXPECT_STREQ(blocked_reason(map, careful, {1.5, 0.5}), "is unknown in the map");
  EXPECT_STREQ(blocked_reason(map, bold, {1.5, 0.5}), "is too close to an obstacle");
  EXPECT_STREQ(blocked_reason(map, careful, {2.5, 0.5}), "is occupied");
}

}  // namespace
}  // namespace patrol::app::plan_grid_test
