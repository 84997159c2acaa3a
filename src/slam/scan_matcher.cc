#include "slam/scan_matcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"
#include "slam/local_line.h"

namespace patrol::slam {
namespace {

constexpr double kStepTolerance_m = 2e-4;
constexpr double kStepTolerance_rad = 1e-5;
constexpr int kMinPoints = 6;  // three points suffice for three unknowns; the margin is for noise

/// Normal equations of the scan terms at a pose, without the prior.
struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double log_likelihood = 0.0;
  int num_observed = 0;  ///< points in observed cells
  int num_matched = 0;   ///< points near a surface, out of num_observed
};

double squared(double value) { return value * value; }

/// Contribution of one point to the normal equations.
struct PointTerm {
  std::optional<LocalLine> line;  ///< none: no surface nearby
  Eigen::Vector2d arm;            ///< vector from the body to the point, rotated into map
  double residual_m = 0.0, variance = 0.0, weight = 0.0;
  double log_likelihood = 0.0;
};

/// Returns none in unobserved cells, and near a surface with too few hits for a line, which the map hardly knows yet.
std::optional<PointTerm> to_term(const GridMap& map, const MatchPoint& point, const Eigen::Matrix2d& R,
                                 const Eigen::Vector2d& t, const ScanMatcherSettings& settings) {
  const double kernel_var = squared(settings.kernel_m);
  PointTerm term{.line = {}, .arm = R * point.p_body};
  const Eigen::Vector2d p_map = t + term.arm;
  const double point_var = squared(settings.point_std_m) + squared(settings.point_angle_std_rad * point.range_m);
  term.line = fit_local_line(map, p_map, settings.surface_radius_cells);
  if (!term.line) {
    const Cell at = map.cell_at(p_map);
    const GridCell* cell = map.find(at);
    if (!cell || !cell->is_observed() || map.is_surface_within(at, settings.surface_radius_cells)) return std::nullopt;
    term.log_likelihood = -0.5 * kernel_var / point_var *
                          std::log1p(squared(settings.surface_radius_cells * map.resolution_m()) / kernel_var);
    return term;
  }
  // Cauchy: loss = kernel^2 log(1 + (r/kernel)^2), weight = 1 / (1 + (r/kernel)^2).
  term.residual_m = term.line->distance_m(p_map);
  term.variance = point_var + term.line->normal_var_m2 + squared(settings.point_std_m) / term.line->num_hits;
  const double ratio = squared(term.residual_m) / kernel_var;
  term.weight = squared(term.line->linearity) / (term.variance * (1.0 + ratio));
  term.log_likelihood = -0.5 * kernel_var / term.variance * std::log1p(ratio);
  return term;
}

NormalEquations linearize(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body,
                          const ScanMatcherSettings& settings) {
  NormalEquations sum;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(T_map_body.yaw).toRotationMatrix();
  const Eigen::Vector2d t = T_map_body.position();
  for (const MatchPoint& point : points) {
    const std::optional<PointTerm> term = to_term(map, point, R, t, settings);
    if (!term) continue;
    ++sum.num_observed;
    sum.log_likelihood += term->log_likelihood;
    if (!term->line) continue;
    ++sum.num_matched;
    const Eigen::Vector2d& n = term->line->normal_map;
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * term->arm.x() - n.x() * term->arm.y());
    sum.H += term->weight * J * J.transpose();
    sum.b += term->weight * term->residual_m * J;
  }
  return sum;
}

/// Number of points on or next to a surface cell.
int count_on_surface(const GridMap& map, const std::vector<Eigen::Vector2d>& rotated, const Eigen::Vector2d& shift) {
  int count = 0;
  for (const Eigen::Vector2d& point : rotated) count += map.is_surface_within(map.cell_at(point + shift), 1) ? 1 : 0;
  return count;
}

}  // namespace

std::optional<MatchResult> match_scan(const GridMap& map, const std::vector<MatchPoint>& points,
                                      const Pose2& T_map_start, const std::optional<PoseGaussian>& prior,
                                      const ScanMatcherSettings& settings) {
  MatchResult result{.T_map_body = T_map_start};
  Eigen::Matrix3d prior_information = Eigen::Matrix3d::Zero();
  if (prior) prior_information = prior->covariance.inverse();

  while (!result.converged && result.iterations < settings.max_iterations) {
    const NormalEquations sum = linearize(map, points, result.T_map_body, settings);
    const double inlier_ratio = sum.num_observed > 0 ? static_cast<double>(sum.num_matched) / sum.num_observed : 0.0;
    if (sum.num_matched < kMinPoints || inlier_ratio < settings.min_inlier_ratio) return std::nullopt;

    Eigen::Matrix3d H = sum.H + prior_information;
    Eigen::Vector3d b = sum.b;
    if (prior) b += prior_information * prior->residual_to_mean(result.T_map_body);
    H.diagonal() += Eigen::Vector3d::Constant(1e-9 * H.trace());  // without a prior a direction may be degenerate
    const Eigen::Vector3d step = -solve_symmetric(H, b);
    if (!step.allFinite()) return std::nullopt;

    result.T_map_body = perturbed(result.T_map_body, step);
    result.information = sum.H;
    result.log_likelihood = sum.log_likelihood;
    result.inlier_ratio = inlier_ratio;
    result.num_matched = sum.num_matched;
    result.converged = step.head<2>().norm() < kStepTolerance_m && std::abs(step.z()) < kStepTolerance_rad;
    ++result.iterations;
  }
  return result;
}

double scan_log_likelihood(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body,
                           const ScanMatcherSettings& settings) {
  const NormalEquations sum = linearize(map, points, T_map_body, settings);
  const double kernel_var = squared(settings.kernel_m);
  const double outlier_loss = std::log1p(squared(settings.surface_radius_cells * map.resolution_m()) / kernel_var);
  const double num_unknown = static_cast<double>(points.size()) - sum.num_observed;
  return sum.log_likelihood - 0.5 * num_unknown * kernel_var / squared(settings.point_std_m) * outlier_loss;
}

std::vector<double> point_log_likelihoods(const GridMap& map, const std::vector<MatchPoint>& points,
                                          const Pose2& T_map_body, const ScanMatcherSettings& settings) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(T_map_body.yaw).toRotationMatrix();
  std::vector<double> log_likelihoods;
  log_likelihoods.reserve(points.size());
  for (const MatchPoint& point : points) {
    const std::optional<PointTerm> term = to_term(map, point, R, T_map_body.position(), settings);
    log_likelihoods.push_back(term ? term->log_likelihood : std::numeric_limits<double>::quiet_NaN());
  }
  return log_likelihoods;
}

Pose2 search_pose(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_center,
                  const ScanMatcherSettings& settings) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(settings.search_points));
  double far_m = 1.0;
  for (const MatchPoint& point : points) far_m = std::max(far_m, point.p_body.norm());
  // A cell and its neighbors cover 1.5 cells each way: steps of two cells skip nothing, also at the farthest point.
  const double step_m = 2.0 * map.resolution_m(), step_rad = 2.0 * map.resolution_m() / far_m;
  const int steps = static_cast<int>(std::ceil(settings.search_window_m / step_m));
  const int num_rotations = static_cast<int>(std::ceil(settings.search_window_rad / step_rad));

  Pose2 best = T_map_center;
  double best_score = -1.0;
  std::vector<Eigen::Vector2d> rotated;
  for (int rotation = -num_rotations; rotation <= num_rotations; ++rotation) {
    const double yaw = T_map_center.yaw + rotation * step_rad;
    const Eigen::Rotation2Dd R(yaw);
    rotated.clear();
    for (std::size_t i = 0; i < points.size(); i += stride) rotated.push_back(R * points[i].p_body);
    for (int i = -steps; i <= steps; ++i) {
      for (int j = -steps; j <= steps; ++j) {
        const Eigen::Vector2d shift = T_map_center.position() + step_m * Eigen::Vector2d(i, j);
        // Prefer the pose closest to the center among equal counts.
        const double tie = 1e-3 * (std::abs(i) + std::abs(j) + std::abs(rotation));
        const double score = count_on_surface(map, rotated, shift) - tie;
        if (score > best_score) best_score = score, best = {shift.x(), shift.y(), wrap_angle(yaw)};
      }
    }
  }
  return best;
}

}  // namespace patrol::slam
