#include "render/map_inset.h"

#include <numbers>

#include <gtest/gtest.h>

#include "render/scene/palette.h"

namespace patrol::render::map_inset_test {
namespace {

/// 10 m x 10 m of free floor in map, with a wall along its +x side.
RunSnapshot snapshot_with_map() {
  OccupancyGrid map({.resolution_m = 0.05, .width = 400, .height = 400, .origin_m = {-10.0, -10.0}}, kUnknown);
  for (int row = 100; row < 300; ++row) {
    for (int col = 100; col < 300; ++col) map.at({col, row}) = col == 299 ? kOccupied : kFree;
  }
  RunSnapshot snapshot;
  snapshot.map = std::make_shared<const OccupancyGrid>(map);
  return snapshot;
}

struct Extent {
  int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, count = 0;
};

template <typename Holds>
Extent extent_of(const Frame& frame, Holds holds) {
  Extent extent;
  for (int y = 0; y < frame.height(); ++y) {
    for (int x = 0; x < frame.width(); ++x) {
      if (!holds(frame.at(x, y))) continue;
      extent = {std::min(extent.left, x), std::max(extent.right, x), std::min(extent.top, y),
                std::max(extent.bottom, y), extent.count + 1};
    }
  }
  return extent;
}

bool is_floor(const Color& c) { return c == Color{214, 218, 222}; }
bool is_wall(const Color& c) { return c == Color{16, 18, 24}; }
bool is_robot(const Color& c) { return c == kRobotColor; }

TEST(MapInsetTest, WithoutAMapTheFrameStaysAsItIs) {
  Frame frame(640, 360, {1, 2, 3});
  MapInset().draw(frame, RunSnapshot{});
  EXPECT_EQ(frame, Frame(640, 360, {1, 2, 3}));
}

TEST(MapInsetTest, ShowsTheKnownPartWithoutDistortion) {
  Frame frame(640, 360);
  MapInset().draw(frame, snapshot_with_map());
  const Extent floor = extent_of(frame, is_floor);
  EXPECT_NEAR(floor.right - floor.left, floor.bottom - floor.top, 3);
  EXPECT_GT(floor.right - floor.left, 100);
  EXPECT_LT(floor.right, 640);
  EXPECT_GT(floor.left, 320);  // in the right half
}

// 100 m x 10 m, with a metre of margin all round.
TEST(MapInsetTest, ALongStripMayTakeFortyTwoHundredthsOfTheWidth) {
  const OccupancyGrid map({.resolution_m = 0.05, .width = 2000, .height = 200, .origin_m = {0.0, 0.0}}, kFree);
  RunSnapshot snapshot;
  snapshot.map = std::make_shared<const OccupancyGrid>(map);
  Frame frame(640, 360);
  MapInset().draw(frame, snapshot);
  const Extent floor = extent_of(frame, is_floor);
  EXPECT_NEAR(floor.right - floor.left, 0.42 * 640 * 100.0 / 102.0, 3);
}

TEST(MapInsetTest, NorthIsUpWhateverTheMapsOwnAxesAre) {
  RunSnapshot snapshot = snapshot_with_map();
  Frame east(640, 360), north(640, 360);
  MapInset().draw(east, snapshot);
  snapshot.T_world_map = {0.0, 0.0, std::numbers::pi / 2.0};  // the wall on map's +x side is in the north
  MapInset().draw(north, snapshot);
  const Extent wall_east = extent_of(east, is_wall), wall_north = extent_of(north, is_wall);
  EXPECT_LE(wall_east.right - wall_east.left, 1);
  EXPECT_GT(wall_east.left, extent_of(east, is_floor).right - 2);
  EXPECT_LE(wall_north.bottom - wall_north.top, 1);
  EXPECT_LT(wall_north.bottom, extent_of(north, is_floor).top + 2);
}

TEST(MapInsetTest, TheRobotStandsWhereItBelievesToBe) {
  RunSnapshot snapshot = snapshot_with_map();
  Frame frame(640, 360);
  MapInset().draw(frame, snapshot);
  EXPECT_GT(extent_of(frame, is_robot).left, extent_of(frame, is_robot).right) << "no estimate: not drawn";
  snapshot.T_map_body = Pose2{};
  MapInset().draw(frame, snapshot);
  const Extent floor = extent_of(frame, is_floor), in_middle = extent_of(frame, is_robot);
  EXPECT_NEAR(0.5 * (in_middle.left + in_middle.right), 0.5 * (floor.left + floor.right), 6.0);
  EXPECT_NEAR(0.5 * (in_middle.top + in_middle.bottom), 0.5 * (floor.top + floor.bottom), 4.0);
  snapshot.T_map_body = Pose2{0.0, 4.0, 0.0};
  MapInset().draw(frame, snapshot);
  EXPECT_LT(extent_of(frame, is_robot).bottom, floor.top + 0.25 * (floor.bottom - floor.top));
}

}  // namespace
}  // namespace patrol::render::map_inset_test
