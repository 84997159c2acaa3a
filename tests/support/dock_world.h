#pragma once

#include <vector>

#include "tests/support/room_world.h"

namespace patrol::test {

/// A post 0.5 m wide with a keel to the robot, in the docked body's frame: its nearest part is 0.65 m ahead of the
/// body.
inline std::vector<Eigen::Vector2d> make_dock_profile() {
  return {{0.9, -0.25}, {0.75, -0.25}, {0.75, -0.1}, {0.65, 0.0}, {0.75, 0.1}, {0.75, 0.25}, {0.9, 0.25}};
}

/// The tunnel's: 0.84 m wide, with two notches 14 cm deep, 0.63 m ahead.
inline std::vector<Eigen::Vector2d> make_notched_dock_profile() {
  return {{0.63, -0.42}, {0.63, -0.34}, {0.77, -0.2}, {0.77, -0.16}, {0.63, -0.06},
          {0.63, 0.06},  {0.77, 0.16},  {0.77, 0.2},  {0.63, 0.34},  {0.63, 0.42}};
}

/// The outline, placed.
inline RoomWorld make_dock_world(const Pose2& T_world_docked, const std::vector<Eigen::Vector2d>& profile_m) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector2d& p : profile_m) points.push_back(T_world_docked * p);
  RoomWorld world;
  world.add_polyline(points);
  return world;
}

/// Scan of a lidar 0.12 m ahead of the body.
inline LevelScan scan_from_mast(const RoomWorld& world, const Pose2& T_world_body, Time stamp, double range_std_m,
                                const RandomStream& noise, std::uint64_t tick) {
  const Pose2 T_level_lidar{0.12, 0.0, 0.0};
  LevelScan scan = world.scan(T_world_body * T_level_lidar, stamp,
                              {.beams = 1600, .range_max_m = 20.0, .range_std_m = range_std_m}, noise, tick);
  scan.origin_m = T_level_lidar.position();
  for (LevelScan::Beam& beam : scan.beams) beam.end_m += scan.origin_m.cast<float>();
  return scan;
}

}  // namespace patrol::test
