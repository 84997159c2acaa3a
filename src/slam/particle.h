#pragma once

#include <memory>
#include <utility>

#include "core/frames.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// The way that a particle has come, shared by all its descendants: a list from the newest keyframe back.
struct PathStep {
  Pose2 T_map_body;
  std::shared_ptr<PathStep> before;

  PathStep(const Pose2& pose, std::shared_ptr<PathStep> earlier) : T_map_body(pose), before(std::move(earlier)) {}
  PathStep(const PathStep&) = delete;
  PathStep& operator=(const PathStep&) = delete;
  /// One after the other: a way of a hundred thousand steps must not be let go by as many calls within each other.
  ~PathStep() {
    while (before && before.use_count() == 1) before = std::move(before->before);
  }
};

/// One hypothesis: where the body was at the last keyframe, and the map that follows from its path.
struct Particle {
  Pose2 T_map_body;
  double log_weight = 0.0;
  GridMap map;
  std::shared_ptr<PathStep> path = nullptr;  ///< at every keyframe so far
};

}  // namespace patrol::slam
