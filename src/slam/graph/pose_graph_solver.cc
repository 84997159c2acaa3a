#include "slam/graph/pose_graph_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
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

/// Residual of a range: (predicted range + delay - range) / standard deviation.
class RangeCost : public ceres::SizedCostFunction<1, 3, 3, 1> {
 public:
  RangeCost(RangeFactor range, double std_m, const UwbCalibration& calibration)
      : range_(std::move(range)), std_m_(std_m), calibration_(calibration) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const double *pose = parameters[0], *survey = parameters[1], *delay_m = parameters[2];
    const Pose2 T_map_node{pose[0], pose[1], pose[2]}, T_survey_map{survey[0], survey[1], survey[2]};
    const Pose2 T_survey_node = T_survey_map * T_map_node;
    const PredictedRange predicted =
        predict_uwb_range(range_.anchor_in_survey, T_survey_node, range_.p_level_antenna, calibration_);
    residuals[0] = (predicted.range_m + delay_m[0] - range_.range_m) / std_m_;
    if (!jacobians) return true;
    const Eigen::Vector2d slope = predicted.H_pose.head<2>() / std_m_;
    const double turn = predicted.H_pose.z() / std_m_;
    if (jacobians[0]) {
      const Eigen::Vector2d slope_in_map = Eigen::Rotation2Dd(-survey[2]) * slope;
      Eigen::Map<Eigen::Vector3d>(jacobians[0]) << slope_in_map.x(), slope_in_map.y(), turn;
    }
    if (jacobians[1]) {
      const Eigen::Vector2d reach = T_survey_node.position() - T_survey_map.position();
      Eigen::Map<Eigen::Vector3d>(jacobians[1]) << slope.x(), slope.y(),
          turn + slope.y() * reach.x() - slope.x() * reach.y();
    }
    if (jacobians[2]) jacobians[2][0] = 1.0 / std_m_;
    return true;
  }

 private:
  RangeFactor range_;
  double std_m_;
  const UwbCalibration& calibration_;  ///< owned by the caller of the solver
};

/// Residual of a position: (p_survey - measured) / standard deviation.
class PositionCost : public ceres::SizedCostFunction<2, 3, 3> {
 public:
  explicit PositionCost(const PositionFactor& position) : position_(position) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const double *pose = parameters[0], *survey = parameters[1];
    const Pose2 T_map_node{pose[0], pose[1], pose[2]}, T_survey_map{survey[0], survey[1], survey[2]};
    const Eigen::Vector2d p_map = T_map_node * position_.p_node_antenna, p_survey = T_survey_map * p_map;
    const double weight = 1.0 / position_.std_m;
    Eigen::Map<Eigen::Vector2d>(residuals).noalias() = weight * (p_survey - position_.p_survey_antenna);
    if (!jacobians) return true;
    using RowMajor = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
    const Eigen::Matrix2d R_survey_map = Eigen::Rotation2Dd(survey[2]).toRotationMatrix();
    const Eigen::Vector2d lever = p_map - T_map_node.position(), reach = p_survey - T_survey_map.position();
    if (jacobians[0]) {
      Eigen::Map<RowMajor> by_pose(jacobians[0]);
      by_pose.leftCols<2>() = weight * R_survey_map;
      by_pose.col(2) = weight * (R_survey_map * Eigen::Vector2d(-lever.y(), lever.x()));
    }
    if (jacobians[1]) {
      Eigen::Map<RowMajor> by_survey(jacobians[1]);
      by_survey.leftCols<2>() = weight * Eigen::Matrix2d::Identity();
      by_survey.col(2) = weight * Eigen::Vector2d(-reach.y(), reach.x());
    }
    return true;
  }

 private:
  PositionFactor position_;
};

/// Residual of parameters with a prior of mean zero: parameters / standard deviations.
template <int N>
class PriorCost : public ceres::SizedCostFunction<N, N> {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  explicit PriorCost(const Vector& std) : weights_(std.cwiseInverse()) {}

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    for (int i = 0; i < N; ++i) residuals[i] = weights_[i] * parameters[0][i];
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<Eigen::Matrix<double, N, N>> by_parameters(jacobians[0]);
    by_parameters.setZero();
    by_parameters.diagonal() = weights_;
    return true;
  }

 private:
  Vector weights_;
};

Eigen::Vector3d prior_std(const PositionFactorsSettings& settings) {
  return {settings.survey_position_std_m, settings.survey_position_std_m, settings.survey_yaw_std_rad};
}

}  // namespace

PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings) {
  SurveyFactors no_factors;
  return solve(graph, settings, no_factors);
}

PoseGraphSolution solve(PoseGraph& graph, const PoseGraphSolverSettings& settings, SurveyFactors& survey,
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
  const RangeFactors& ranges = survey.ranges;
  ceres::CauchyLoss range_kernel(ranges.outlier_scale_sigma());
  Eigen::Vector3d survey_map = survey.positions.T_survey_map().vector();
  std::map<int, double> delays_m = ranges.delays_m();  // the addresses of its values are constant
  for (const RangeFactor& range : ranges.ranges()) {
    problem.AddResidualBlock(new RangeCost(range, ranges.std_m(range), ranges.calibration()), &range_kernel,
                             node(range.node), survey_map.data(), &delays_m[range.anchor_in_survey.number]);
  }
  for (auto& [anchor, delay_m] : delays_m)
    problem.AddResidualBlock(new PriorCost<1>(PriorCost<1>::Vector(ranges.delay_std_m())), nullptr, &delay_m);
  for (const PositionFactor& position : survey.positions.positions())
    problem.AddResidualBlock(new PositionCost(position), &kernel, node(position.node), survey_map.data());
  if (problem.HasParameterBlock(survey_map.data()))
    problem.AddResidualBlock(new PriorCost<3>(prior_std(survey.positions.settings())), nullptr, survey_map.data());
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
  survey.ranges.set_delays(std::move(delays_m));
  survey.positions.set_survey({survey_map.x(), survey_map.y(), wrap_angle(survey_map.z())});
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
