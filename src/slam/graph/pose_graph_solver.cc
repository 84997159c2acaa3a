#include "slam/graph/pose_graph_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <ceres/ceres.h>

#include "core/geometry/linear_algebra.h"

namespace patrol::slam {
namespace {

/// L^T (R_from^T (p_to - p_from) - p, yaw_to - yaw_from - yaw), with L L^T the information.
class EdgeCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit EdgeCost(const PoseGraphEdge& edge)
      : T_from_to_(edge.T_from_to), root_(cholesky_factor(edge.information).transpose()) {}

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override {
    const double *from = poses[0], *to = poses[1];
    const double c = std::cos(from[2]), s = std::sin(from[2]), dx = to[0] - from[0], dy = to[1] - from[1];
    const Eigen::Vector3d error(c * dx + s * dy - T_from_to_.x, -s * dx + c * dy - T_from_to_.y,
                                wrap_angle(to[2] - from[2] - T_from_to_.yaw));
    Eigen::Map<Eigen::Vector3d>(residuals).noalias() = root_ * error;
    if (!jacobians) return true;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians[0]) {
      Eigen::Matrix3d by_from;
      by_from << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0.0, 0.0, -1.0;
      Eigen::Map<RowMajor>(jacobians[0]).noalias() = root_ * by_from;
    }
    if (jacobians[1]) {
      Eigen::Matrix3d by_to;
      by_to << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
      Eigen::Map<RowMajor>(jacobians[1]).noalias() = root_ * by_to;
    }
    return true;
  }

 private:
  Pose2 T_from_to_;
  Eigen::Matrix3d root_;
};

/// Residual of a range: (predicted range - range) / standard deviation.
class RangeCost : public ceres::SizedCostFunction<1, 3> {
 public:
  RangeCost(RangeFactor range, double std_m, const UwbCalibration& calibration)
      : range_(std::move(range)), std_m_(std_m), calibration_(calibration) {}

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override {
    const Pose2 T_map_constrained = range_.T_map_constrained({poses[0][0], poses[0][1], poses[0][2]});
    const PredictedRange predicted =
        predict_uwb_range(range_.anchor, T_map_constrained, range_.p_level_antenna, calibration_);
    residuals[0] = (predicted.range_m - range_.range_m) / std_m_;
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Vector3d H_pose = predicted.H_pose;
    if (range_.direction) H_pose << range_.direction->dot(predicted.H_pose.head<2>()) * *range_.direction, 0.0;
    Eigen::Map<Eigen::Vector3d>(jacobians[0]).noalias() = H_pose / std_m_;
    return true;
  }

 private:
  RangeFactor range_;
  double std_m_;
  const UwbCalibration& calibration_;  ///< owned by the caller of the solver
};

}  // namespace

PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings, const RangeFactors& ranges,
                        int num_fixed_nodes) {
  std::vector<std::array<double, 3>> poses;
  for (const Pose2& pose : graph.T_map_node) poses.push_back({pose.x, pose.y, pose.yaw});

  ceres::CauchyLoss kernel(settings.loop_closure_loss_scale);
  ceres::Problem::Options problem_options;
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;  // one kernel for all residual blocks
  ceres::Problem problem(problem_options);
  const auto node = [&](int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= poses.size())
      throw std::invalid_argument("pose graph: edge to unknown node " + std::to_string(index));
    return poses[static_cast<std::size_t>(index)].data();
  };
  for (const PoseGraphEdge& edge : graph.edges) {
    double *const from = node(edge.from), *const to = node(edge.to);
    if (edge.from < num_fixed_nodes && edge.to < num_fixed_nodes) continue;
    const bool is_robust = settings.robust_loop_closures && edge.kind == PoseGraphEdge::Kind::kLoop;
    problem.AddResidualBlock(new EdgeCost(edge), is_robust ? &kernel : nullptr, from, to);
  }
  for (const RangeFactor& range : ranges.ranges()) {
    if (range.node >= num_fixed_nodes)
      problem.AddResidualBlock(new RangeCost(range, ranges.std_m(range), ranges.calibration()), &kernel,
                               node(range.node));
  }
  for (std::size_t i = 0; i < std::min(poses.size(), static_cast<std::size_t>(num_fixed_nodes)); ++i) {
    if (problem.HasParameterBlock(poses[i].data())) problem.SetParameterBlockConstant(poses[i].data());
  }
  if (problem.NumResidualBlocks() == 0) return {.converged = true};

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = settings.max_iterations;
  options.function_tolerance = 1e-9;
  options.num_threads = 1;  // keeps the order of floating-point sums, so that results are reproducible
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (auto i = static_cast<std::size_t>(num_fixed_nodes); i < poses.size(); ++i)
    graph.T_map_node[i] = {poses[i][0], poses[i][1], wrap_angle(poses[i][2])};
  return {.initial_cost = summary.initial_cost,
          .final_cost = summary.final_cost,
          .iterations = summary.num_successful_steps,
          .converged = summary.termination_type == ceres::CONVERGENCE};
}

Eigen::Vector3d edge_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node) {
  const Pose2& T_map_from = T_map_node[static_cast<std::size_t>(edge.from)];
  const Pose2 T_from_to = T_map_from.inverse() * T_map_node[static_cast<std::size_t>(edge.to)];
  return {T_from_to.x - edge.T_from_to.x, T_from_to.y - edge.T_from_to.y,
          wrap_angle(T_from_to.yaw - edge.T_from_to.yaw)};
}

double squared_residual(const PoseGraphEdge& edge, const std::vector<Pose2>& T_map_node) {
  const Eigen::Vector3d error = edge_residual(edge, T_map_node);
  return error.dot(edge.information * error);
}

}  // namespace patrol::slam
