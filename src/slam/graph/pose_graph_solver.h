#pragma once

#include "core/pose_graph.h"
#include "core/settings.h"
#include "slam/graph/range_factors.h"

namespace patrol::slam {

struct PoseGraphSolverSettings {
  int max_iterations = 50;
  bool robust_loop_closures = true;
  /// Scale of the Cauchy kernel, in standard deviations; used for loop closures if robust_loop_closures, and always for ranges.
  double loop_closure_loss_scale = 3.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_iterations", self.max_iterations, between(1, 1000));
    visit("robust_loop_closures", self.robust_loop_closures);
    visit("loop_closure_loss_scale", self.loop_closure_loss_scale, at_least(0.1));
  }
};

struct PoseGraphSolution {
  double initial_cost = 0.0;  ///< half the sum of squared residuals, after the kernels
  double final_cost = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Optimizes the poses of all nodes from `num_fixed_nodes` on, with the edges and the ranges to fixed anchors in map. Sparse
/// nonlinear least squares with Cauchy kernels on ranges and, if `robust_loop_closures` is set, on loop closures. Nodes before
/// `num_fixed_nodes` are fixed. Throws std::invalid_argument if an edge refers to an unknown node.
PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings, const RangeFactors& ranges = {}, int num_fixed_nodes = 1);

/// Residual of an edge: (x, y, yaw) of the relative pose of its nodes minus the measurement, in the frame of `from`.
Eigen::Vector3d edge_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);
/// Squared Mahalanobis norm of the residual of an edge.
double squared_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);

}  // namespace patrol::slam
