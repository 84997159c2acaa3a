#pragma once

#include <vector>

#include "core/pose_graph.h"
#include "core/trajectory.h"

namespace patrol::app {

/// Accuracy of a graph's loop closures compared with the ground truth.
struct LoopClosureAccuracy {
  std::size_t right = 0, wrong = 0;     ///< closures by correctness; right: within 0.3 m and 0.05 rad
  std::size_t returns = 0, closed = 0;  ///< revisits within 5 m after 30 m of path; those with a right closure

  double precision() const;  ///< 1 without closures
  double recall() const;     ///< 1 without returns
};

/// Evaluates the loop closures. Edges between consecutive nodes are not closures. `T_world_node`: ground truth, [node].
LoopClosureAccuracy evaluate_loop_closures(const PoseGraph& graph, const std::vector<Pose2>& T_world_node);

}  // namespace patrol::app
