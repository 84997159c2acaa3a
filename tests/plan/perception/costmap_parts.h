#pragma once

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "plan/perception/costmap.h"
#include "tests/support/pose_near.h"
#include "tests/support/room_world.h"

namespace patrol::plan::costmap_test {

using test::RoomWorld;
using test::VectorNear;

/// 0.8 by 0.4 m about the body's origin: inscribed radius 0.2 m.
inline Footprint make_robot() { return Footprint({{-0.4, -0.2}, {0.4, -0.2}, {0.4, 0.2}, {-0.4, 0.2}}); }

/// Known free ground, 10 m by 10 m about the origin.
inline OccupancyGrid make_free_map(double resolution_m = 0.1) {
  const int cells = static_cast<int>(std::lround(10.0 / resolution_m));
  return OccupancyGrid({.resolution_m = resolution_m, .width = cells, .height = cells, .origin_m = {-5.0, -5.0}},
                       kFree);
}

inline void occupy(OccupancyGrid& map, const Eigen::Vector2d& p) { map.at(map.geometry().cell_at(p)) = kOccupied; }

inline Costmap make_costmap(const OccupancyGrid& map, const CostmapSettings& settings = {}) {
  Costmap costmap(settings, make_robot(), {});
  costmap.set_map(map);
  return costmap;
}

/// A scan that sees along one beam only, which ends at `p_map`: all others are blocked, without echo, at the
/// robot's skin. The lidar stands at the body's origin.
inline LevelScan one_beam(const Pose2& T_map_body, const Eigen::Vector2d& p_map, double time_s, bool is_hit = true) {
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

}  // namespace patrol::plan::costmap_test
