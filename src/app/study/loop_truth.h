#pragma once

#include <vector>

#include "core/pose_graph.h"
#include "core/trajectory.h"

namespace patrol::app {

/// How true a graph's loop closures are.
struct LoopTruth {
  std::size_t right = 0, wrong = 0;          ///< closures; right: within 0.3 m and 0.05 rad of the truth
  std::size_t returns = 0, closed = 0;       ///< nodes that came back within 5 m of an older one after 30 m of way; and those with a right closure to such a one

  double precision() const;  ///< 1 without closures
  double recall() const;     ///< 1 without returns
};

/// Edges between a node and the next are no closures. `T_world_node` [node].
LoopTruth judge_loops(const PoseGraph& graph, const std::vector<Pose2>& T_world_node);

}  // namespace patrol::app
