#include "slam/submaps/ndt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/linear_algebra.h"
#include "slam/submaps/point_tree.h"

namespace patrol::slam {
namespace {

constexpr double kMaxNodes = 4000.0;     // along either axis
constexpr double kNdtTurnArm_m = 10.0;   // distance at which the rotation of a step is evaluated
constexpr double kMinCellWeight = 1e-6;  // a cell whose points are all on its border has no covariance

/// One of the four nodes around a point, with its bilinear weight.
struct NodeWeight {
  Cell node;
  double weight;             ///< 0 ... 1
  Eigen::Vector2d gradient;  ///< gradient of the weight, 1/m
};

std::array<NodeWeight, 4> bilinear_weights(const Eigen::Vector2d& from_origin_m, double spacing_m) {
  const double u = from_origin_m.x() / spacing_m, v = from_origin_m.y() / spacing_m;
  const int col = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
  const double a = u - col, b = v - row, slope = 1.0 / spacing_m;
  return {{{{col, row}, (1.0 - a) * (1.0 - b), {-slope * (1.0 - b), -slope * (1.0 - a)}},
           {{col + 1, row}, a * (1.0 - b), {slope * (1.0 - b), -slope * a}},
           {{col, row + 1}, (1.0 - a) * b, {-slope * b, slope * (1.0 - a)}},
           {{col + 1, row + 1}, a * b, {slope * b, slope * a}}}};
}

/// Lattice that covers all points. Nodes are at multiples of the spacing, independent of the points.
GridGeometry covering_lattice(const std::vector<Eigen::Vector2d>& points, double spacing_m) {
  check_finite(points);
  if (points.empty()) return {.resolution_m = spacing_m};
  Eigen::Vector2d low = points.front(), high = points.front();
  for (const Eigen::Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Array2d first = (low.array() / spacing_m).floor(), last = (high.array() / spacing_m).floor() + 1.0;
  const double max_nodes = (last - first).maxCoeff() + 1.0;
  if (max_nodes > kMaxNodes)
    throw InputError(fmt::format("ndt: lattice of {} nodes of {} m along an axis: must be at most {}", max_nodes,
                                 spacing_m, kMaxNodes));
  return {.resolution_m = spacing_m,
          .width = static_cast<int>(last.x() - first.x()) + 1,
          .height = static_cast<int>(last.y() - first.y()) + 1,
          .origin_m = spacing_m * first.matrix()};
}

/// Weighted sums of the points of a cell, relative to the node.
struct CellSums {
  double weight = 0.0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
};

/// Inverse of the covariance, with both standard deviations at least `min_std_m`.
Eigen::Matrix2d floored_information(const Eigen::Matrix2d& covariance, double min_std_m) {
  const SymmetricEigen<2> axes = symmetric_eigen_direct(covariance);
  const Eigen::Vector2d variances = axes.values.cwiseMax(min_std_m * min_std_m);
  return axes.vectors * variances.cwiseInverse().asDiagonal() * axes.vectors.transpose();
}

}  // namespace

NdtGrid::NdtGrid(const std::vector<Eigen::Vector2d>& points_target, double cell_m, double min_std_m)
    : node_spacing_m_(0.5 * cell_m) {
  const GridGeometry lattice = covering_lattice(points_target, node_spacing_m_);
  origin_m_ = lattice.origin_m;
  cell_of_node_ = Grid<int>(lattice, -1);

  std::vector<CellSums> sums;
  for (const Eigen::Vector2d& p : points_target) {
    for (const NodeWeight& node_weight : bilinear_weights(p - origin_m_, node_spacing_m_)) {
      if (node_weight.weight <= kMinCellWeight) continue;
      int& cell = cell_of_node_.at(node_weight.node);
      if (cell < 0) {
        cell = static_cast<int>(sums.size());
        sums.emplace_back();
        cells_.push_back(
            {.mean = origin_m_ + node_spacing_m_ * Eigen::Vector2d(node_weight.node.col, node_weight.node.row)});
      }
      CellSums& sum = sums[static_cast<std::size_t>(cell)];
      const Eigen::Vector2d from_node = p - cells_[static_cast<std::size_t>(cell)].mean;
      sum.weight += node_weight.weight;
      sum.first += node_weight.weight * from_node;
      sum.second += node_weight.weight * from_node * from_node.transpose();
    }
  }
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    const Eigen::Vector2d mean = sums[cell].first / sums[cell].weight;
    const Eigen::Matrix2d covariance = sums[cell].second / sums[cell].weight - mean * mean.transpose();
    cells_[cell].mean += mean;
    cells_[cell].information = floored_information(covariance, min_std_m);
  }
}

void NdtGrid::add(const Eigen::Vector2d& p_target, const Eigen::Vector2d& arm, NdtScore& sum) const {
  Eigen::Matrix<double, 2, 3> J;  // Jacobian of the point with respect to the pose
  J << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  for (const NodeWeight& node_weight : bilinear_weights(p_target - origin_m_, node_spacing_m_)) {
    if (!cell_of_node_.contains(node_weight.node)) continue;
    const int index = cell_of_node_.at(node_weight.node);
    if (index < 0) continue;
    const NormalCell& cell = cells_[static_cast<std::size_t>(index)];
    const Eigen::Vector2d q = p_target - cell.mean, pull = cell.information * q;
    const double fit = std::exp(-0.5 * q.dot(pull));
    sum.value += node_weight.weight * fit;
    sum.gradient += J.transpose() * (fit * (node_weight.gradient - node_weight.weight * pull));
    sum.curvature += node_weight.weight * fit * (J.transpose() * cell.information * J);
  }
}

NdtScore NdtGrid::score(const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_target_source) const {
  NdtScore sum;
  const double c = std::cos(T_target_source.yaw), s = std::sin(T_target_source.yaw);
  const Eigen::Vector2d t = T_target_source.position();
  // Node indices of points far outside the lattice would overflow an int.
  const GridGeometry& lattice = cell_of_node_.geometry();
  const Eigen::Vector2d low = origin_m_.array() - node_spacing_m_;
  const Eigen::Vector2d high = origin_m_ + node_spacing_m_ * Eigen::Vector2d(lattice.width, lattice.height);
  for (const Eigen::Vector2d& p : points_source) {
    const Eigen::Vector2d arm(c * p.x() - s * p.y(), s * p.x() + c * p.y()), p_target = t + arm;
    if ((p_target.array() >= low.array()).all() && (p_target.array() <= high.array()).all()) add(p_target, arm, sum);
  }
  return sum;
}

std::vector<NdtGrid> make_ndt(const std::vector<Eigen::Vector2d>& points_target, const NdtSettings& settings) {
  std::vector<NdtGrid> levels;
  levels.reserve(settings.cells_m.size());
  for (const double cell_m : settings.cells_m)
    levels.emplace_back(points_target, cell_m, settings.min_std_per_cell * cell_m);
  return levels;
}

std::vector<Eigen::Vector2d> subsample(const std::vector<Eigen::Vector2d>& points, int max_points) {
  const auto max_count = static_cast<std::size_t>(max_points);
  if (points.size() <= max_count) return points;
  std::vector<Eigen::Vector2d> kept(max_count);
  for (std::size_t i = 0; i < max_count; ++i) kept[i] = points[i * points.size() / max_count];
  return kept;
}

namespace {

/// State of one optimization.
struct ScoreMaximum {
  Pose2 T_target_source;
  NdtScore score;
  int iterations = 0;
  bool converged = false;
};

Pose2 stepped(const Pose2& T_target_source, const Eigen::Vector3d& step) {
  return {T_target_source.x + step.x(), T_target_source.y + step.y(), wrap_angle(T_target_source.yaw + step.z())};
}

/// Levenberg-Marquardt: the damping decreases after accepted steps and increases after rejected ones.
ScoreMaximum maximize_score(const NdtGrid& grid, const std::vector<Eigen::Vector2d>& points, const Pose2& T_start,
                            const NdtSettings& settings) {
  constexpr double kMaxDamping = 1e7;
  ScoreMaximum at{.T_target_source = T_start, .score = grid.score(points, T_start)};
  const double step_tolerance = settings.step_tolerance_per_cell * grid.cell_m();
  double damping = 1e-3;
  while (!at.converged && at.iterations < settings.max_iterations && at.score.value > 0.0) {
    ++at.iterations;
    Eigen::Matrix3d H = at.score.curvature;
    H.diagonal() *= 1.0 + damping;
    const Eigen::Vector3d step = solve_symmetric(H, at.score.gradient);
    const Pose2 T_next = stepped(at.T_target_source, step);
    const NdtScore next = step.allFinite() ? grid.score(points, T_next) : NdtScore{};
    if (next.value > at.score.value) {
      at.T_target_source = T_next;
      at.score = next;
      damping = std::max(1e-9, 0.2 * damping);
    } else {
      damping *= 10.0;
    }
    at.converged = damping > kMaxDamping ||
                   (step.head<2>().norm() < step_tolerance && kNdtTurnArm_m * std::abs(step.z()) < step_tolerance);
  }
  return at;
}

/// Returns whether another result is equal within a hundredth of a cell at 10 m from the origin.
bool is_near_any(const Pose2& T_target_source, const std::vector<ScoreMaximum>& maxima, double cell_m) {
  return std::ranges::any_of(maxima, [&](const ScoreMaximum& other) {
    const Pose2& T = other.T_target_source;
    return (T.position() - T_target_source.position()).norm() < 0.01 * cell_m &&
           kNdtTurnArm_m * std::abs(wrap_angle(T.yaw - T_target_source.yaw)) < 0.01 * cell_m;
  });
}

/// Negative Hessian of the score by central differences of the gradient over half a node, made positive semidefinite.
Eigen::Matrix3d measured_information(const NdtGrid& grid, const std::vector<Eigen::Vector2d>& points,
                                     const Pose2& T_target_source) {
  const double step_m = 0.25 * grid.cell_m();
  const Eigen::Vector3d steps(step_m, step_m, step_m / kNdtTurnArm_m);
  Eigen::Matrix3d fall;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d step = steps[k] * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d ahead = grid.score(points, stepped(T_target_source, step)).gradient;
    const Eigen::Vector3d behind = grid.score(points, stepped(T_target_source, -step)).gradient;
    fall.col(k) = (behind - ahead) / (2.0 * steps[k]);
  }
  const SymmetricEigen<3> axes = symmetric_eigen(Eigen::Matrix3d(0.5 * (fall + fall.transpose())));
  return axes.vectors * axes.values.cwiseMax(0.0).asDiagonal() * axes.vectors.transpose();
}

}  // namespace

std::optional<NdtResult> align_ndt(const std::vector<NdtGrid>& target,
                                   const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_start,
                                   const NdtSettings& settings) {
  const std::vector<Eigen::Vector2d> points = subsample(points_source, settings.max_points);
  if (points.empty()) return std::nullopt;
  // Start every level from `T_start` and from all results of the coarser level.
  std::vector<ScoreMaximum> found;
  int iterations = 0;
  for (const NdtGrid& grid : target) {
    std::vector<ScoreMaximum> maxima{maximize_score(grid, points, T_start, settings)};
    for (const ScoreMaximum& coarser : found) {
      if (is_near_any(coarser.T_target_source, maxima, grid.cell_m())) continue;
      maxima.push_back(maximize_score(grid, points, coarser.T_target_source, settings));
    }
    for (const ScoreMaximum& each : maxima) iterations += each.iterations;
    found = std::move(maxima);
  }
  const auto best = std::ranges::max_element(found, {}, [](const ScoreMaximum& each) { return each.score.value; });
  if (best == found.end() || !(best->score.value > 0.0)) return std::nullopt;
  return NdtResult{.T_target_source = best->T_target_source,
                   .information = measured_information(target.back(), points, best->T_target_source),
                   .score = best->score.value / static_cast<double>(points.size()),
                   .iterations = iterations,
                   .converged = best->converged};
}

}  // namespace patrol::slam
