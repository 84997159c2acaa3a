#pragma once

#include <vector>

#include <Eigen/Core>

#include "slam/grid_map.h"
#include "slam/scan_integration.h"
#include "tests/support/room_world.h"

namespace patrol::test {

/// A submap as mapping makes it, at known poses.
struct SeenSubmap {
  slam::GridMap map{0.05, 400.0};
  std::vector<Eigen::Vector2d> points;  ///< means of the surface cells
};

/// Submap from scans of 20 m range and 1 cm of noise at poses in the world. `seed`: seed of the noise.
inline SeenSubmap see_submap(const RoomWorld& world, const Pose2& T_world_submap,
                             const std::vector<Pose2>& T_world_body, std::uint64_t seed) {
  SeenSubmap submap;
  const RandomStream noise(seed, "test/see_submap");
  constexpr RoomWorld::ScanOptions kLidar{
      .beams = 720, .range_max_m = 20.0, .no_return_clearing_range_m = 6.0, .range_std_m = 0.01};
  for (std::size_t i = 0; i < T_world_body.size(); ++i) {
    slam::integrate_scan(world.scan(T_world_body[i], Time{}, kLidar, noise, i),
                         T_world_submap.inverse() * T_world_body[i], {}, submap.map);
  }
  submap.map.for_each_tile([&](Cell first, const slam::GridTile& tile) {
    for (int row = 0; row < slam::GridTile::kSize; ++row) {
      for (int col = 0; col < slam::GridTile::kSize; ++col) {
        const slam::GridCell cell = tile.at(col, row);
        if (!cell.is_surface() || cell.hits < 2) continue;
        submap.points.push_back(submap.map.center_of({first.col + col, first.row + row}) +
                                Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m));
      }
    }
  });
  return submap;
}

/// Five poses, half a metre apart, along the heading.
inline std::vector<Pose2> short_walk(const Pose2& T_world_start) {
  std::vector<Pose2> poses;
  for (int i = 0; i < 5; ++i) poses.push_back(T_world_start * Pose2{0.5 * i, 0.0, 0.0});
  return poses;
}

}  // namespace patrol::test
