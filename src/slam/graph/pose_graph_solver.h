#pragma once

#include "core/pose_graph.h"
#include "slam/graph/pose_graph_solver_settings.h"
#include "slam/graph/survey_factors.h"

namespace patrol::slam {

struct PoseGraphSolution {
  double initial_cost = 0.0;  ///< half the sum of squared residuals, after the kernels
  double final_cost = 0.0;
  int iterations = 0;
  bool converged = false;
};

/// Optimizes the poses of all nodes with the edges.
/// Sparse nonlinear least squares, with Cauchy kernels on loop closures if `robust_loop_closures` is set. The first
/// node is fixed. Throws std::invalid_argument if an edge refers to an unknown node.
PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings);
/// As above, also with the ranges to fixed anchors in map and the positions in survey, which have Cauchy kernels.
/// Optimizes the delays of the anchors and the pose of map in survey with the nodes. Nodes before `num_fixed_nodes` are
/// fixed.
PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings, SurveyFactors& survey,
                        int num_fixed_nodes = 1);

/// Residual of an edge: (x, y, yaw) of the relative pose of its nodes minus the measurement, in the frame of `from`.
Eigen::Vector3d edge_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);
/// Squared Mahalanobis norm of the residual of an edge.
double squared_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node);

}  // namespace patrol::slam
