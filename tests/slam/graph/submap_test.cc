#include "slam/graph/submap.h"

#include <memory>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "tests/slam/graph/rendered_submap.h"

namespace patrol::slam::submap_test {
namespace {

// From (2, 1) in the world, looking along y: what lies in the world at (x, y) lies in the submap at (y - 1, 2 - x).
TEST(RenderedSubmap, IsInTheFrameOfItsFirstKeyframeToHalfACell) {
  test::RoomWorld room;
  room.add_box(-1.0, -2.0, 5.0, 6.0);
  const Pose2 T_world_first{2.0, 1.0, std::numbers::pi / 2};
  std::vector<Keyframe> keyframes;
  std::vector<Pose2> poses = {
      {}, T_world_first, T_world_first * Pose2{0.5, 0.0, 0.3}};  // the first node is no part of it
  for (const Pose2& pose : poses) keyframes.push_back({ScanGroup(room.scan(pose, {})), {}});
  const RenderedSubmap submap({.first = 1, .last = 2}, keyframes, poses, {});
  ASSERT_GT(submap.surface_points().size(), 200U);  // 28 m of wall, a point every 0.1 m
  for (const MatchPoint& point : submap.surface_points())
    EXPECT_LT(room.distance_m(T_world_first * point.p_body), 0.025);  // in a corner a square has both walls
}

TEST(RenderedSubmap, HasOneSurfacePointForEveryTwoByTwoCells) {
  const RenderedSubmap submap = test::drive_past(test::make_office(), {{8.0, 4.2}, {10.0, 4.2}}, 1);
  EXPECT_DOUBLE_EQ(submap.point_spacing_m(), 2 * 0.05);
  std::set<std::pair<int, int>> squares;
  for (const MatchPoint& point : submap.surface_points()) {
    const Cell cell = submap.map().cell_at(point.p_body);
    squares.insert({cell.row >> 1, cell.col >> 1});
  }
  EXPECT_EQ(squares.size(), submap.surface_points().size());
}

TEST(RenderedSubmap, KeepsNothingBeyondItsExtent) {
  test::RoomWorld room;
  room.add_box(-10.0, -2.0, 10.0, 2.0);
  const std::vector<Keyframe> keyframes = {{ScanGroup(room.scan({}, {})), {}}, {ScanGroup(room.scan({}, {})), {}}};
  const RenderedSubmap submap({.first = 0, .last = 1}, keyframes, {{}, {}}, {.max_extent_m = 8.0});
  ASSERT_FALSE(submap.surface_points().empty());
  const double tile_m = 0.05 * GridTile::kSize;  // whole tiles are kept
  for (const MatchPoint& point : submap.surface_points()) EXPECT_LT(std::abs(point.p_body.x()), 4.0 + tile_m);
}

TEST(SubmapCache, RendersOnceAndDropsTheLeastRecentlyUsed) {
  const RenderedSubmap rendered = test::drive_past(test::make_office(), {{8.0, 4.2}, {9.0, 4.2}}, 1);
  SubmapCache cache(2);
  int draws = 0;
  const auto get = [&](int submap) {
    cache.get(submap, [&] {
      ++draws;
      return std::make_shared<const RenderedSubmap>(rendered);
    });
  };
  for (const int submap : {0, 1, 0, 2, 0}) get(submap);
  EXPECT_EQ(draws, 3);
  get(1);
  EXPECT_EQ(draws, 4);
}

}  // namespace
}  // namespace patrol::slam::submap_test
