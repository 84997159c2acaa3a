#include "plan/perception/costmap.h"
#include "tests/plan/perception/costmap_parts.h"

namespace patrol::plan::costmap_test {
namespace {

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

TEST(Costmap, ReplacedKeepOutLinesEqualThoseOfAFreshCostmap) {
  const CostmapSettings settings{.unknown_cost = 0.0, .keep_out_margin_m = 0.2, .keep_out_inflation_m = 0.3};
  const std::vector<Polyline> moved = {{{-3.0, 0.4}, {4.0, 0.6}}};
  Costmap costmap(settings, make_robot(), {{{-3.0, 0.0}, {3.0, 0.0}}});
  costmap.set_keep_out_lines(moved);
  const Costmap fresh(settings, make_robot(), moved);
  for (double x = -3.95; x < 5.0; x += 0.1) {
    for (double y = -1.95; y < 2.0; y += 0.1)
      ASSERT_EQ(costmap.cost_at({x, y}), fresh.cost_at({x, y})) << x << ' ' << y;
  }
  EXPECT_EQ(costmap.cost_at({0.0, -0.1}), kFreeCost);  // lethal before
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
