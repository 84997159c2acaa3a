#pragma once

#include "core/pose_graph.h"
#include "core/settings.h"
#include "slam/graph/node_ranges.h"

namespace patrol::slam {

struct PoseGraphSolverSettings {
  int max_iterations = 50;
  bool doubts_loops = true;
  double loop_kernel = 3.0;  ///< standard deviations from which on a loop closure counts as an outlier, gradually; a range always

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_iterations", self.max_iterations, between(1, 1000));
    visit("doubts_loops", self.doubts_loops);
    visit("loop_kernel", self.loop_kernel, at_least(0.1));
  }
};

struct PoseGraphSolution {
  double initial_cost = 0.0;  ///< half the sum of squares, loop closures and ranges by their kernel
  double final_cost = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Moves all nodes from `first_free` on to where the edges, and ranges to what stands in map, want them most: sparse least squares, with Cauchy's kernel on
/// ranges, and on loop closures unless they are to be believed. The others stay where they are.
/// Throws std::invalid_argument when an edge names a node that is not there.
PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings, const NodeRanges& ranges = {}, int first_free = 1);

/// What an edge lacks: (x, y, yaw) of its measurement's inverse times where the nodes stand.
Eigen::Vector3d edge_error(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);
/// Its squared Mahalanobis length.
double squared_error(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);

}  // namespace patrol::slam
