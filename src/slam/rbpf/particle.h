#pragma once

#include <memory>
#include <utility>

#include "core/frames.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Node of a particle's trajectory, a linked list from the newest keyframe backward that all descendants share.
struct TrajectoryNode {
  Pose2 T_map_body;
  std::shared_ptr<TrajectoryNode> before;

  TrajectoryNode(const Pose2& pose, std::shared_ptr<TrajectoryNode> earlier)
      : T_map_body(pose), before(std::move(earlier)) {}
  TrajectoryNode(const TrajectoryNode&) = delete;
  TrajectoryNode& operator=(const TrajectoryNode&) = delete;
  /// Frees the list in a loop: recursion over a trajectory of 100,000 steps would overflow the stack.
  ~TrajectoryNode() {
    while (before && before.use_count() == 1) before = std::move(before->before);
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(T_map_body, before);
  }
};

/// Particle of the grid RBPF: body pose at the last keyframe and the map that follows from its trajectory.
struct Particle {
  Pose2 T_map_body;
  double log_weight = 0.0;
  GridMap map;
  std::shared_ptr<TrajectoryNode> path = nullptr;  ///< trajectory: poses at all keyframes
};

}  // namespace patrol::slam
