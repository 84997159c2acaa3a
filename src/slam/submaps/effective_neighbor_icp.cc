#include "slam/submaps/effective_neighbor_icp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"
#include "slam/rigid_motion.h"

namespace patrol::slam {
namespace {

constexpr double kIcpTurnArm_m = 10.0;  // distance at which the rotation of a step is evaluated

/// Source point and its nearest target point, with their distance at the current pose.
struct Pair {
  std::size_t source = 0;
  std::size_t target = 0;
  double distance_m = 0.0;
};

bool have_compatible_normals(const Eigen::Vector2d& normal_target, const Eigen::Vector2d& normal_source,
                             double yaw_rad) {
  return normal_target.dot(Pose2{0.0, 0.0, yaw_rad} * normal_source) >= 0.0;  // zero: normal unknown
}

/// Pairs each source point with the nearest target point whose normal is not opposite, within `max_threshold_m` if it
/// is not the nearest of all.
std::vector<Pair> nearest_pairs(const IcpPoints& target, const IcpPoints& source, const Pose2& T_target_source,
                                const IcpSettings& settings) {
  std::vector<Pair> pairs;
  pairs.reserve(source.points().size());
  const auto add = [&](std::size_t i, const PointTree::Neighbor& found) {
    if (!have_compatible_normals(target.free_space_normals()[found.index], source.free_space_normals()[i],
                                 T_target_source.yaw))
      return false;
    pairs.push_back({.source = i, .target = found.index, .distance_m = std::sqrt(found.squared_distance_m2)});
    return true;
  };
  for (std::size_t i = 0; i < source.points().size(); ++i) {
    const Eigen::Vector2d p_target = T_target_source * source.points()[i];
    const PointTree::Neighbor nearest = target.tree().nearest(p_target);
    if (add(i, nearest) || nearest.squared_distance_m2 > settings.max_threshold_m * settings.max_threshold_m) continue;
    for (const PointTree::Neighbor& found : target.tree().within(p_target, settings.max_threshold_m)) {
      if (add(i, found)) break;
    }
  }
  return pairs;
}

double threshold_of(const std::vector<Pair>& pairs, const IcpSettings& settings, bool is_point_to_line) {
  if (!settings.use_effective_neighbors || pairs.empty()) return std::numeric_limits<double>::infinity();
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const Pair& pair : pairs) distances.push_back(pair.distance_m);
  std::ranges::sort(distances);
  return std::clamp(
      effective_threshold(distances), settings.min_threshold_m,
      std::max(settings.min_threshold_m, is_point_to_line ? settings.line_threshold_m : settings.max_threshold_m));
}

std::vector<Pair> effective_pairs(std::vector<Pair> pairs, const IcpSettings& settings, bool is_point_to_line) {
  const double threshold_m = threshold_of(pairs, settings, is_point_to_line);
  std::erase_if(pairs, [&](const Pair& pair) { return pair.distance_m > threshold_m; });
  return pairs;
}

Pose2 motion_of(const std::vector<Pair>& pairs, const std::vector<Eigen::Vector2d>& points_target,
                const std::vector<Eigen::Vector2d>& points_source) {
  std::vector<Eigen::Vector2d> p, q;
  p.reserve(pairs.size());
  q.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    p.push_back(points_target[pair.target]);
    q.push_back(points_source[pair.source]);
  }
  return fit_rigid_motion(p, q);
}

/// Normal equations H step = b of the pairs for x, y, yaw in target, with independent pairs. Distances are taken across
/// linear surfaces and in both directions elsewhere.
struct PointToLineEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

PointToLineEquations linearize(const std::vector<Pair>& pairs, const IcpPoints& target,
                               const std::vector<Eigen::Vector2d>& points_source, const Pose2& T_target_source,
                               const IcpSettings& settings) {
  PointToLineEquations sum;
  for (const Pair& pair : pairs) {
    const SurfaceNormal& surface = target.normals()[pair.target];
    const Eigen::Vector2d& n = surface.normal;
    const Eigen::Vector2d p_target = T_target_source * points_source[pair.source],
                          arm = p_target - T_target_source.position();
    const Eigen::Vector3d J(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
    const Eigen::Vector2d error = p_target - target.points()[pair.target];
    const double straight = surface.linearity * surface.linearity,
                 round = (1.0 - surface.linearity) * (1.0 - surface.linearity);
    const double squared_m2 = straight * std::pow(n.dot(error), 2) + round * error.squaredNorm();
    const double weight = 1.0 / (1.0 + squared_m2 / (settings.line_kernel_m * settings.line_kernel_m)) /
                          (settings.point_std_m * settings.point_std_m);
    sum.H += weight * straight * J * J.transpose();
    sum.b -= weight * straight * n.dot(error) * J;
    Eigen::Matrix<double, 2, 3> K;
    K << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
    sum.H += weight * round * K.transpose() * K;
    sum.b -= weight * round * K.transpose() * error;
  }
  return sum;
}

/// Gauss-Newton step on the distances, with damping against motion along a corridor.
Pose2 point_to_line_step(const PointToLineEquations& lines, const Pose2& T_target_source) {
  constexpr double kDamping = 1e-2;
  const double shift = lines.H(0, 0) + lines.H(1, 1);
  Eigen::Matrix3d H = lines.H;
  H.diagonal() += kDamping * Eigen::Vector3d(shift, shift, lines.H(2, 2));
  const Eigen::Vector3d step = solve_symmetric(H, lines.b);
  if (!step.allFinite()) return T_target_source;
  return {T_target_source.x + step.x(), T_target_source.y + step.y(), wrap_angle(T_target_source.yaw + step.z())};
}

double rms_of(const std::vector<Pair>& pairs) {
  double squared = 0.0;
  for (const Pair& pair : pairs) squared += pair.distance_m * pair.distance_m;
  return std::sqrt(squared / static_cast<double>(pairs.size()));
}

double largest_distance(const std::vector<Pair>& pairs) {
  return std::ranges::max(pairs, {}, &Pair::distance_m).distance_m;
}

bool is_small(const Pose2& T_step, double tolerance_m) {
  return T_step.position().norm() + kIcpTurnArm_m * std::abs(T_step.yaw) <= tolerance_m;
}

}  // namespace

double effective_threshold(const std::vector<double>& sorted_distances) {
  const std::size_t n = sorted_distances.size();
  const double first = sorted_distances.front(), last = sorted_distances.back();
  double max_departure = 0.0, threshold = last;
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double chord = first + (last - first) * static_cast<double>(k) / static_cast<double>(n - 1);  // eq. 7
    const double departure = chord - sorted_distances[k];                                               // eq. 8
    if (departure <= 0.0 || departure < max_departure) continue;
    max_departure = departure;
    threshold = sorted_distances[k];
  }
  return threshold;
}

std::optional<IcpResult> align_icp(const IcpPoints& target, const IcpPoints& source, const Pose2& T_start,
                                   const IcpSettings& settings) {
  if (target.points().empty() || source.points().empty()) return std::nullopt;
  IcpResult result{.T_target_source = T_start};
  bool is_point_to_line = false;
  while (!result.converged && result.iterations < settings.max_iterations) {
    const std::vector<Pair> pairs =
        effective_pairs(nearest_pairs(target, source, result.T_target_source, settings), settings, is_point_to_line);
    if (pairs.size() < static_cast<std::size_t>(settings.min_pairs)) return std::nullopt;
    const PointToLineEquations lines = linearize(pairs, target, source.points(), result.T_target_source, settings);
    const Pose2 T_next = is_point_to_line ? point_to_line_step(lines, result.T_target_source)
                                          : motion_of(pairs, target.points(), source.points());
    const bool is_still = is_small(result.T_target_source.inverse() * T_next, settings.step_tolerance_m);
    result = {.T_target_source = T_next,
              .information = lines.H,
              .num_pairs = static_cast<int>(pairs.size()),
              .threshold_m = largest_distance(pairs),
              .rms_m = rms_of(pairs),
              .iterations = result.iterations + 1,
              .converged = is_still && is_point_to_line == settings.point_to_line};
    is_point_to_line = is_point_to_line || (is_still && settings.point_to_line);
  }
  return result;
}

}  // namespace patrol::slam
