#include "render/reference_map.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/render/small_scene.h"

namespace patrol::render::reference_map_test {
namespace {

std::int8_t value_at(const OccupancyGrid& map, double x, double y) {
  const Cell cell = map.geometry().cell_at({x, y});
  return map.contains(cell) ? map.at(cell) : kFree;
}

/// What each cell should be when `inside(x, y)` says what is solid; returns how many cells differ.
template <typename Inside>
int num_wrong(const OccupancyGrid& map, Inside inside) {
  const double r = map.geometry().resolution_m;
  int wrong = 0;
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      const Eigen::Vector2d p = map.geometry().center_of({col, row});
      const auto solid = [&](double dx, double dy) { return inside(p.x() + dx, p.y() + dy); };
      const bool is_buried = solid(r, 0.0) && solid(-r, 0.0) && solid(0.0, r) && solid(0.0, -r);
      const std::int8_t expected = !solid(0.0, 0.0) ? kFree : is_buried ? kUnknown : kOccupied;
      wrong += map.at({col, row}) != expected;
    }
  }
  return wrong;
}

std::size_t num_occupied(const OccupancyGrid& map) {
  return static_cast<std::size_t>(std::ranges::count(map.values(), kOccupied));
}

TEST(ReferenceMapTest, ABoxIsItsOutlineWithTheUnknownInside) {
  // 1 m x 0.5 m from (2.01, 1.01): 40 x 20 cells of 2.5 cm, of which 2 * 40 + 2 * 18 are the outline.
  const auto model = small_scene(R"(<geom type="box" size="0.5 0.25 0.5" pos="2.51 1.26 0.5"/>)");
  const ReferenceMap reference = reference_map(*model);
  EXPECT_EQ(num_wrong(reference.map, [](double x, double y) { return x > 2.01 && x < 3.01 && y > 1.01 && y < 1.51; }),
            0);
  EXPECT_EQ(num_occupied(reference.map), 2u * 40 + 2 * 18);
  EXPECT_EQ(reference.check.agreement_ratio(), 1.0);
  EXPECT_EQ(reference.check.num_added, 0u);
}

TEST(ReferenceMapTest, SurfaceCellsLieBehindTheSurfaceByLessThanACell) {
  const auto model = small_scene(R"(<geom type="box" size="0.5 0.5 0.5" pos="0.013 0.004 0.5" euler="0 0 27"/>)");
  const OccupancyGrid map = reference_map(*model).map;
  const double c = std::cos(to_rad(27.0)), s = std::sin(to_rad(27.0));
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      if (map.at({col, row}) != kOccupied) continue;
      const Eigen::Vector2d p = map.geometry().center_of({col, row}) - Eigen::Vector2d(0.013, 0.004);
      const double behind = 0.5 - std::max(std::abs(c * p.x() + s * p.y()), std::abs(-s * p.x() + c * p.y()));
      EXPECT_GE(behind, 0.0);
      EXPECT_LE(behind, 0.025);
    }
  }
}

TEST(ReferenceMapTest, ASphereIsCutAtTheHeightThatWasAsked) {
  // Radius 0.5 m, cut 0.3 m above its middle: a circle of 0.4 m.
  const auto model = small_scene(R"(<geom type="sphere" size="0.5" pos="1.003 2.004 0.5"/>)");
  const OccupancyGrid map = reference_map(*model, {.height_m = 0.8}).map;
  for (int row = 0; row < map.geometry().height; ++row) {
    for (int col = 0; col < map.geometry().width; ++col) {
      const double distance = (map.geometry().center_of({col, row}) - Eigen::Vector2d(1.003, 2.004)).norm();
      if (distance > 0.39 && distance < 0.4) continue;  // the round shapes of a render have corners
      EXPECT_EQ(map.at({col, row}) == kFree, distance > 0.4);
    }
  }
}

/// A ridge along y: its height rises evenly from 0 at x = -2.01 m to 1 m at x = -0.01 m and falls again.
constexpr const char* kRidge = R"(<hfield name="ridge" nrow="2" ncol="3" size="2 1 1 0.3" elevation="0 1 0 0 1 0"/>)";

TEST(ReferenceMapTest, AHeightFieldIsCutWhereItsGroundIsHigherThanTheLidar) {
  // Higher than 0.4 m within 0.6 * 2 m of the ridge.
  const auto model = small_scene(R"(<geom type="hfield" hfield="ridge" pos="-0.01 0.01 0" group="2"/>)", kRidge);
  const ReferenceMap reference = reference_map(*model, {.height_m = 0.4});
  EXPECT_EQ(
      num_wrong(reference.map, [](double x, double y) { return std::abs(x + 0.01) < 1.2 && y > -0.99 && y < 1.01; }),
      0);
  EXPECT_EQ(reference.check.agreement_ratio(), 1.0);
}

TEST(ReferenceMapTest, GroundBelowTheLidarIsNoSurface) {
  const auto model = small_scene(R"(<geom type="hfield" hfield="ridge" pos="0 0 -0.7" group="2"/>
                                    <geom type="box" size="0.5 0.25 0.5" pos="2.51 1.26 0.5"/>)",
                                 kRidge);
  EXPECT_EQ(num_occupied(reference_map(*model, {.height_m = 0.4}).map), 2u * 40 + 2 * 18);
}

TEST(ReferenceMapTest, OverlappingThingsAreOne) {
  const auto model = small_scene(R"(<geom type="box" size="0.5 0.5 0.5" pos="0.51 0.51 0.5"/>
                                    <geom type="box" size="0.5 0.2 0.3" pos="1.01 0.51 0.3"/>
                                    <geom type="cylinder" size="0.1 0.2" pos="0.51 0.51 0.3"/>)");
  const ReferenceMap reference = reference_map(*model);
  EXPECT_EQ(num_wrong(reference.map,
                      [](double x, double y) {
                        return (x > 0.01 && x < 1.01 && y > 0.01 && y < 1.01) ||
                               (x > 0.51 && x < 1.51 && y > 0.31 && y < 0.71);
                      }),
            0);
  EXPECT_EQ(reference.check.agreement_ratio(), 1.0);
}

TEST(ReferenceMapTest, ShowsWhatTheLidarCanHitAndNothingElse) {
  const auto model = small_scene(R"(<geom group="0" type="box" size="0.2 0.2 0.5" pos="0 0 0.5"/>
                                    <geom group="1" type="box" size="0.2 0.2 0.5" pos="1 0 0.5"/>
                                    <geom group="2" type="box" size="0.2 0.2 0.5" pos="2 0 0.5" rgba="1 1 1 0"/>
                                    <geom group="3" type="box" size="0.2 0.2 0.5" pos="3 0 0.5"/>
                                    <geom group="0" type="box" size="0.2 0.2 0.5" pos="4 0 0.5" rgba="1 1 1 0"/>
                                    <geom group="0" type="box" size="0.2 0.2 0.1" pos="5 0 0.1"/>
                                    <geom group="0" type="box" size="0.2 0.2 0.1" pos="6 0 2.1"/>
                                    <geom group="0" type="plane" size="0 0 1"/>
                                    <geom group="0" type="box" size="0.2 0.2 0.5" pos="7 0 0.5"/>)");
  const OccupancyGrid map = reference_map(*model).map;
  EXPECT_EQ(value_at(map, 0.0, 0.0), kUnknown) << "solid";
  EXPECT_EQ(value_at(map, 1.0, 0.0), kFree) << "seen by the eye only";
  EXPECT_EQ(value_at(map, 2.0, 0.0), kUnknown) << "hit by the lidar only";
  EXPECT_EQ(value_at(map, 3.0, 0.0), kFree) << "touched only";
  EXPECT_EQ(value_at(map, 4.0, 0.0), kFree) << "transparent";
  EXPECT_EQ(value_at(map, 5.0, 0.0), kFree) << "below the slice";
  EXPECT_EQ(value_at(map, 6.0, 0.0), kFree) << "above the slice";
  EXPECT_EQ(value_at(map, 7.0, 0.0), kUnknown) << "solid";
}

TEST(ReferenceMapTest, LeavesOutWhatMoves) {
  const auto model = small_scene(R"(<geom type="box" size="0.2 0.2 0.5" pos="0 0 0.5"/>
                                    <body pos="1 0 0.5"><geom type="box" size="0.2 0.2 0.5"/></body>
                                    <body pos="2 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5"/></body>
                                    <body pos="3 0 0.5"><freejoint/><geom type="box" size="0.2 0.2 0.5"/></body>
                                    <geom type="box" size="0.2 0.2 0.5" pos="4 0 0.5"/>)");
  const OccupancyGrid map = reference_map(*model).map;
  EXPECT_EQ(value_at(map, 1.0, 0.0), kUnknown) << "a body without a joint stands still";
  EXPECT_EQ(value_at(map, 2.0, 0.0), kFree) << "an actor";
  EXPECT_EQ(value_at(map, 3.0, 0.0), kFree) << "a body that is free";
}

TEST(ReferenceMapTest, HasActorsThatStandStillForTheWholeRun) {
  const auto model = small_scene(R"(<geom type="box" size="0.2 0.2 0.5" pos="0 0 0.5"/>
      <body name="car" pos="1 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5"/></body>
      <body name="walker" pos="2 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5"/></body>
      <body name="walker_shank_left" pos="3 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5"/></body>
      <body pos="4 0 0.5" mocap="true"><geom type="box" size="0.2 0.2 0.5"/></body>)");
  const OccupancyGrid map = reference_map(*model, {.actors = {{"walker"}}}).map;
  EXPECT_EQ(value_at(map, 1.0, 0.0), kUnknown);
  EXPECT_EQ(value_at(map, 2.0, 0.0), kFree);
  EXPECT_EQ(value_at(map, 3.0, 0.0), kFree) << "a limb";
  EXPECT_EQ(value_at(map, 4.0, 0.0), kUnknown) << "without a name";
}

TEST(ReferenceMapTest, RaysAddWhatIsThinnerThanACell) {
  // 5 mm of sheet metal at x = 1.005 ... 1.01: no cell's centre (0.9875, 1.0125) is in it.
  const auto model = small_scene(R"(<geom type="box" size="0.0025 0.5 0.5" pos="1.0075 0.51 0.5"/>)");
  const ReferenceMap reference = reference_map(*model);
  for (double y = 0.03; y < 1.0; y += 0.025) EXPECT_EQ(value_at(reference.map, 1.0075, y), kOccupied) << y;
  EXPECT_EQ(reference.check.num_added, num_occupied(reference.map));
  EXPECT_EQ(reference.check.agreement_ratio(), 0.0);
}

TEST(ReferenceMapTest, IsSeamlessAcrossRenderedTiles) {
  // 40 m of wall are 1600 cells: more than one tile.
  const auto model = small_scene(R"(<geom type="box" size="20 0.15 0.5" pos="20.01 0.16 0.5"/>)");
  const ReferenceMap reference = reference_map(*model);
  EXPECT_EQ(num_wrong(reference.map, [](double x, double y) { return x > 0.01 && x < 40.01 && y > 0.01 && y < 0.31; }),
            0);
}

TEST(ReferenceMapTest, RenderAndRaysAgreeOnShapesOfEveryKind) {
  const auto model = small_scene(R"(<geom type="box" size="0.5 0.3 0.5" pos="0 0 0.5" euler="10 20 30"/>
                                    <geom type="cylinder" size="0.3 0.6" pos="2 0 0.5" euler="20 0 0"/>
                                    <geom type="ellipsoid" size="0.6 0.3 0.5" pos="4 0 0.5" euler="0 30 50"/>
                                    <geom type="capsule" size="0.2 0.5" pos="0 2 0.5" euler="0 70 0"/>
                                    <geom type="sphere" size="0.5" pos="2 2 0.2"/>
                                    <geom type="cylinder" size="0.04 1" pos="4 2 1"/>)");
  const ReferenceMapCheck check = reference_map(*model).check;
  EXPECT_GT(check.num_checked, 500u);
  EXPECT_GE(check.agreement_ratio(), 0.999);
}

TEST(ReferenceMapTest, AWorldWithoutSurfacesIsAnErrorWithoutVisitedPositionsAndFreeAroundThemWithThem) {
  const sim::ModelPtr model = small_scene(R"(<geom type="plane" size="0 0 1"/>)");
  EXPECT_THROW(reference_map(*model), InputError);
  const ReferenceMap reference =
      reference_map(*model, {.resolution_m = 0.1, .margin_m = 1.0, .visited_m = {{0.0, 0.0}, {4.0, -2.0}}});
  EXPECT_EQ(num_occupied(reference.map), 0u);
  EXPECT_EQ(reference.map.geometry().width, 60);
  EXPECT_EQ(reference.map.geometry().height, 40);
  EXPECT_EQ(reference.map.geometry().origin_m, Eigen::Vector2d(-1.0, -3.0));
  EXPECT_EQ(reference.check.agreement_ratio(), 1.0);
}

TEST(ReferenceMapTest, VisitedPositionsDoNotChangeTheMapOfAWorldWithSurfaces) {
  const sim::ModelPtr model = small_scene(R"(<geom type="box" size="1 0.5 0.5"/>)");
  const OccupancyGrid map = reference_map(*model).map;
  EXPECT_EQ(reference_map(*model, {.visited_m = {{50.0, 0.0}}}).map.values(), map.values());
}

}  // namespace
}  // namespace patrol::render::reference_map_test
