#include "slam/scan_matcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"
#include "slam/line_fit.h"

namespace patrol::slam {
namespace {

constexpr double kStepTolerance_m = 2e-4;
constexpr double kStepTolerance_rad = 1e-5;
/// Distance from a known optimum below which an iteration would converge to it.
constexpr double kSameOptimum_m = 0.005, kSameOptimum_rad = 0.005;
constexpr int kMinPoints = 6;  // three points suffice for three unknowns; the margin is for noise

double squared(double value) { return value * value; }

/// Cauchy loss of a point: kernel^2 log(1 + ratio) / (2 variance).
struct Loss {
  double variance = 1.0;
  double ratio = 0.0;  ///< squared residual / squared scale of the kernel
};

/// Contribution of one point to the normal equations.
struct PointTerm {
  bool has_line = false;  ///< false: no surface nearby
  double normal_x = 0.0, normal_y = 0.0;
  double arm_x_m = 0.0, arm_y_m = 0.0;  ///< vector from the body to the point, rotated into map
  double residual_m = 0.0, weight = 0.0;
  Loss loss = {};
};

/// Terms of the points of a scan at a pose.
class Terms {
 public:
  Terms(const GridMap& map, const Pose2& T_map_body, const ScanMatcherSettings& settings)
      : map_(map),
        settings_(settings),
        R_(Eigen::Rotation2Dd(T_map_body.yaw).toRotationMatrix()),
        t_(T_map_body.position()) {}

  /// Returns false in unobserved cells, and near a surface with too few hits for a line, which the map hardly knows
  /// yet. `term` is then undefined.
  bool compute(const MatchPoint& point, PointTerm& term) const {
    const double x = point.p_body.x(), y = point.p_body.y();
    term.arm_x_m = R_(0, 0) * x + R_(0, 1) * y, term.arm_y_m = R_(1, 0) * x + R_(1, 1) * y;
    const double px = t_.x() + term.arm_x_m, py = t_.y() + term.arm_y_m;
    const Eigen::Vector2d p_map(px, py);
    const double point_var = point_std_var_ + squared(settings_.point_angle_std_rad * point.range_m);
    LineFit line;
    term.has_line = fit_line(map_, p_map, settings_.surface_radius_cells, line);
    if (!term.has_line) {
      term.loss = {.variance = point_var, .ratio = unmatched_ratio_};
      const Cell at = map_.cell_at(p_map);
      const std::optional<GridCell> cell = map_.find(at);
      return cell && cell->is_observed() && !map_.is_surface_within(at, settings_.surface_radius_cells);
    }
    // Cauchy: loss = kernel^2 log(1 + (r/kernel)^2), weight = 1 / (1 + (r/kernel)^2).
    term.normal_x = line.normal_x, term.normal_y = line.normal_y;
    term.residual_m = line.normal_x * (px - (px + line.mean_x_m)) + line.normal_y * (py - (py + line.mean_y_m));
    const double variance = point_var + line.normal_var_m2 + point_std_var_ / line.num_hits,
                 ratio = squared(term.residual_m) / kernel_var_;
    term.weight = squared(line.linearity) / (variance * (1.0 + ratio));
    term.loss = {.variance = variance, .ratio = ratio};
    return true;
  }

  double log_likelihood(const Loss& loss) const {
    const double log = loss.ratio == unmatched_ratio_ ? unmatched_log_ : std::log1p(loss.ratio);
    return -0.5 * kernel_var_ / loss.variance * log;
  }

 private:
  const GridMap& map_;
  const ScanMatcherSettings& settings_;
  Eigen::Matrix2d R_;
  Eigen::Vector2d t_;
  double point_std_var_ = squared(settings_.point_std_m);
  double kernel_var_ = squared(settings_.kernel_m);
  double unmatched_ratio_ = squared(settings_.surface_radius_cells * map_.resolution_m()) / kernel_var_;
  double unmatched_log_ = std::log1p(unmatched_ratio_);
};

/// Normal equations of the scan terms at a pose, without the prior.
struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  int num_matched = 0;  ///< points near a surface, out of those in observed cells
};

/// Fills `losses` with those of the points in observed cells. Sums are in scalars, which stay in registers.
NormalEquations linearize(const Terms& terms, const std::vector<MatchPoint>& points, std::vector<Loss>& losses) {
  double xx = 0.0, xy = 0.0, xz = 0.0, yx = 0.0, yy = 0.0, yz = 0.0, zx = 0.0, zy = 0.0, zz = 0.0;
  double bx = 0.0, by = 0.0, bz = 0.0;
  int num_matched = 0;
  losses.clear();
  PointTerm term;
  for (const MatchPoint& point : points) {
    if (!terms.compute(point, term)) continue;
    losses.push_back(term.loss);
    if (!term.has_line) continue;
    ++num_matched;
    const double x = term.normal_x, y = term.normal_y, z = y * term.arm_x_m - x * term.arm_y_m;  // Jacobian
    const double wx = term.weight * x, wy = term.weight * y, wz = term.weight * z, wr = term.weight * term.residual_m;
    xx += wx * x, xy += wx * y, xz += wx * z;  // to the bit, the sum is not symmetric
    yx += wy * x, yy += wy * y, yz += wy * z;
    zx += wz * x, zy += wz * y, zz += wz * z;
    bx += wr * x, by += wr * y, bz += wr * z;
  }
  NormalEquations sum{.num_matched = num_matched};
  sum.H << xx, xy, xz, yx, yy, yz, zx, zy, zz;
  sum.b << bx, by, bz;
  return sum;
}

double total_log_likelihood(const Terms& terms, const std::vector<Loss>& losses) {
  double sum = 0.0;
  for (const Loss& loss : losses) sum += terms.log_likelihood(loss);
  return sum;
}

bool is_near(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() < kSameOptimum_m &&
         std::abs(wrap_angle(a.yaw - b.yaw)) < kSameOptimum_rad;
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
                                      const ScanMatcherSettings& settings, const Pose2* T_map_known) {
  MatchResult result{.T_map_body = T_map_start};
  Eigen::Matrix3d prior_information = Eigen::Matrix3d::Zero();
  if (prior) prior_information = prior->covariance.inverse();
  std::vector<Loss> losses;
  losses.reserve(points.size());

  while (!result.converged && result.iterations < settings.max_iterations) {
    const Terms terms(map, result.T_map_body, settings);
    const NormalEquations sum = linearize(terms, points, losses);
    const double inlier_ratio = losses.empty() ? 0.0 : sum.num_matched / static_cast<double>(losses.size());
    if (sum.num_matched < kMinPoints || inlier_ratio < settings.min_inlier_ratio) return std::nullopt;

    Eigen::Matrix3d H = sum.H + prior_information;
    Eigen::Vector3d b = sum.b;
    if (prior) b += prior_information * prior->residual_to_mean(result.T_map_body);
    H.diagonal() += Eigen::Vector3d::Constant(1e-9 * H.trace());  // without a prior a direction may be degenerate
    const Eigen::Vector3d step = -solve_symmetric(H, b);
    if (!step.allFinite()) return std::nullopt;

    result.T_map_body = perturbed(result.T_map_body, step);
    if (T_map_known && is_near(result.T_map_body, *T_map_known)) return std::nullopt;
    result.information = sum.H;
    result.inlier_ratio = inlier_ratio;
    result.num_matched = sum.num_matched;
    result.converged = step.head<2>().norm() < kStepTolerance_m && std::abs(step.z()) < kStepTolerance_rad;
    ++result.iterations;
    if (result.converged || result.iterations == settings.max_iterations)
      result.log_likelihood = total_log_likelihood(terms, losses);
  }
  return result;
}

double scan_log_likelihood(const GridMap& map, const std::vector<MatchPoint>& points, const Pose2& T_map_body,
                           const ScanMatcherSettings& settings) {
  const Terms terms(map, T_map_body, settings);
  double sum = 0.0;
  std::size_t num_observed = 0;
  PointTerm term;
  for (const MatchPoint& point : points) {
    if (!terms.compute(point, term)) continue;
    sum += terms.log_likelihood(term.loss);
    ++num_observed;
  }
  const double kernel_var = squared(settings.kernel_m);
  const double outlier_loss = std::log1p(squared(settings.surface_radius_cells * map.resolution_m()) / kernel_var);
  const double num_unknown = static_cast<double>(points.size()) - static_cast<double>(num_observed);
  return sum - 0.5 * num_unknown * kernel_var / squared(settings.point_std_m) * outlier_loss;
}

std::vector<double> point_log_likelihoods(const GridMap& map, const std::vector<MatchPoint>& points,
                                          const Pose2& T_map_body, const ScanMatcherSettings& settings) {
  const Terms terms(map, T_map_body, settings);
  std::vector<double> log_likelihoods;
  log_likelihoods.reserve(points.size());
  PointTerm term;
  for (const MatchPoint& point : points) {
    const bool is_known = terms.compute(point, term);
    log_likelihoods.push_back(is_known ? terms.log_likelihood(term.loss) : std::numeric_limits<double>::quiet_NaN());
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
