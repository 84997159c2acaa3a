#include "slam/graph/incremental_map.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"

namespace patrol::slam::incremental_map_test {
namespace {

/// Scans along a room of 8 m x 4 m.
struct Drive {
  std::vector<Keyframe> keyframes;
  std::vector<Pose2> poses;

  void go_to(double x) {
    test::RoomWorld room;
    room.add_box(-2.0, -2.0, 6.0, 2.0);
    poses.push_back({x, 0.0, 0.0});
    keyframes.push_back({ScanGroup(room.scan(poses.back(), {})), {}});
  }
};

/// The farthest cell with hits, along x.
double farthest_hit_m(const GridMap& map) {
  double farthest = -1e9;
  map.for_each_tile([&](Cell first, const GridTile& tile) {
    for (int row = 0; row < GridTile::kSize; ++row) {
      for (int col = 0; col < GridTile::kSize; ++col) {
        if (tile.at(col, row).hits > 0)
          farthest = std::max(farthest, map.center_of({first.col + col, first.row + row}).x());
      }
    }
  });
  return farthest;
}

int hits_in(const GridMap& map) {
  int hits = 0;
  map.for_each_tile([&](Cell, const GridTile& tile) {
    for (const GridTile::Hits& cell : tile.hits) hits += cell.count;
  });
  return hits;
}

TEST(IncrementalMap, WritesEveryKeyframeOnce) {
  Drive drive;
  drive.go_to(0.0);
  IncrementalMap live({});
  const int one = hits_in(live.render(drive.keyframes, drive.poses, 0.03));
  EXPECT_GT(one, 0);
  EXPECT_EQ(hits_in(live.render(drive.keyframes, drive.poses, 0.03)), one);
  drive.go_to(0.5);
  EXPECT_EQ(hits_in(live.render(drive.keyframes, drive.poses, 0.03)), 2 * one);  // every beam of both hits the box
}

// The second scan moves by 0.5 m: its end wall, at 6 m, is then seen at 6.5 m.
TEST(IncrementalMap, IsRenderedAgainWhenAKeyframeHasMovedByMoreThanTheThreshold) {
  Drive drive;
  drive.go_to(0.0), drive.go_to(0.5);
  IncrementalMap live({});
  EXPECT_NEAR(farthest_hit_m(live.render(drive.keyframes, drive.poses, 0.03)), 6.0, 0.05);
  drive.poses[1].x += 0.5;
  EXPECT_NEAR(farthest_hit_m(live.render(drive.keyframes, drive.poses, 0.6)), 6.0, 0.05);
  const GridMap& moved = live.render(drive.keyframes, drive.poses, 0.4);
  EXPECT_NEAR(farthest_hit_m(moved), 6.5, 0.05);
  EXPECT_EQ(hits_in(moved), hits_in(IncrementalMap({}).render(drive.keyframes, drive.poses, 0.0)));
}

// A hundredth of a radian swings what is ten meters away by 0.1 m.
TEST(IncrementalMap, ARotationCountsByItsDisplacementAtTenMeters) {
  Drive drive;
  drive.go_to(0.0), drive.go_to(0.5);
  IncrementalMap live({});
  const auto mean_of = [&](double max_shift_m) {
    double sum = 0.0;
    live.render(drive.keyframes, drive.poses, max_shift_m).for_each_tile([&](Cell, const GridTile& tile) {
      for (const GridTile::Hits& cell : tile.hits) sum += cell.mean_y_m;
    });
    return sum;
  };
  const double before = mean_of(0.0);
  drive.poses[1].yaw += 0.01;
  EXPECT_EQ(mean_of(0.11), before);
  EXPECT_NE(mean_of(0.09), before);
}

}  // namespace
}  // namespace patrol::slam::incremental_map_test
