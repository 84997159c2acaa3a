#pragma once

#include <memory>
#include <utility>

#include "core/frames.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Node of a particle's trajectory, a linked list from the newest keyframe backward that all descendants share.
struct PathStep {
  Pose2 T_map_body;
  std::shared_ptr<PathStep> before;

  PathStep(const Pose2& pose, std::shared_ptr<PathStep> earlier) : T_map_body(pose), before(std::move(earlier)) {}
  PathStep(const PathStep&) = delete;
  PathStep& operator=(const PathStep&) = delete;
  /// Frees the list in a loop: recursion over a trajectory of 100,000 steps would overflow the stack.
  ~PathStep() {
    while (before && before.use_count() == 1) before = std::move(before->before);
  }
};

/// Particle of the grid RBPF: body pose at the last keyframe and the map that follows from its trajectory.
struct Particle {
  Pose2 T_map_body;
  double log_weight = 0.0;
  GridMap map;
  std::shared_ptr<PathStep> path = nullptr;  ///< trajectory: poses at all keyframes
};

}  // namespace patrol::slam
