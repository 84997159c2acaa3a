#pragma once

#include <cstdint>
#include <vector>

#include "slam/graph/submap.h"
#include "tests/slam/graph/office_world.h"

namespace patrol::test {

/// A submap drawn from scans every half meter along a way, at their true poses; its frame is the first of them.
inline slam::RenderedSubmap drive_past(const RoomWorld& world, const std::vector<Eigen::Vector2d>& way,
                                       std::uint64_t seed, const RoomWorld::ScanOptions& lidar = kOldLidar) {
  std::vector<slam::Keyframe> keyframes;
  std::vector<Pose2> poses;
  const RandomStream noise(seed, "test/submap");
  for (const DriveStep& step : drive_along(way, {.speed_mps = 0.5, .turn_radps = 0.5, .period_s = 1.0})) {
    keyframes.push_back({slam::ScanGroup(world.scan(step.T_world_body, step.stamp, lidar, noise, keyframes.size())),
                         step.T_world_body});
    poses.push_back(step.T_world_body);
  }
  return slam::RenderedSubmap({.first = 0, .last = static_cast<int>(keyframes.size()) - 1}, keyframes, poses, {});
}

}  // namespace patrol::test
