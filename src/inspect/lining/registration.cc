#include "inspect/lining/registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"

namespace patrol::inspect {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kRegistrationArm_m = 10.0;  // distance at which the rotation of a step counts
constexpr double kPairCosine = 0.8;          // minimum cosine between the normals of a pair
// Point spacing on a surface: the distance of a pair exceeds that of its surfaces by up to this.
constexpr double kSpacing_m = 0.1;
constexpr std::size_t kMinPairs = 30;

/// Returns the bin of a normal, without sign: the three pairs of cube faces have 3 x 3 cells each.
int direction_of(const Eigen::Vector3d& normal) {
  Eigen::Index axis = 0;
  const double largest = normal.cwiseAbs().maxCoeff(&axis);
  const double u = normal[(axis + 1) % 3] / (largest * (normal[axis] < 0.0 ? -1.0 : 1.0)),
               v = normal[(axis + 2) % 3] / (largest * (normal[axis] < 0.0 ? -1.0 : 1.0));
  const auto third = [](double value) { return value < -1.0 / 3.0 ? 0 : value < 1.0 / 3.0 ? 1 : 2; };
  return static_cast<int>(axis) * 9 + third(u) * 3 + third(v);
}

/// Samples points of the cloud: equal numbers from all normal directions, as far as available, and uniformly within
/// each.
std::vector<std::size_t> sample_of(const SurfaceCloud& cloud, int size) {
  std::array<std::vector<std::size_t>, 27> facing;
  for (std::size_t i = 0; i < cloud.points().size(); ++i) {
    const Eigen::Vector3d& normal = cloud.surfaces()[i].normal;
    if (!normal.isZero()) facing[static_cast<std::size_t>(direction_of(normal))].push_back(i);
  }
  std::ranges::sort(facing, {}, [](const auto& points) { return points.size(); });
  std::vector<std::size_t> sample;
  auto rest = static_cast<std::size_t>(size), directions = facing.size();
  for (const auto& points : facing) {
    const std::size_t take = std::min(points.size(), rest / directions--);
    for (std::size_t k = 0; k < take; ++k) sample.push_back(points[k * points.size() / take]);
    rest -= take;
  }
  return sample;
}

struct Pair {
  Eigen::Vector3d normal, arm;  // in target; `arm` is measured from the origin of the source
  double residual_m = 0.0;
};

std::optional<Pair> pair_of(const SurfaceCloud& target, const SurfaceCloud& source, std::size_t i,
                            const Pose3& T_target_source, double distance_m) {
  const Eigen::Vector3d p = T_target_source * source.points()[i].p;
  const auto near = target.nearest(p, 1);
  const double max_pair_distance_m = distance_m + kSpacing_m;
  if (near.count == 0 || near.squared_m2[0] > max_pair_distance_m * max_pair_distance_m) return std::nullopt;
  const SurfaceCloud::Surface& surface = target.surfaces()[near.index[0]];
  if (std::abs(surface.normal.dot(T_target_source.rotation * source.surfaces()[i].normal)) < kPairCosine)
    return std::nullopt;
  return Pair{.normal = surface.normal,
              .arm = p - T_target_source.position,
              .residual_m = surface.normal.dot(p - surface.mean)};
}

}  // namespace

Pose3 apply_step(const Pose3& T_target_source, const Vector6& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  const double angle = turn.norm();
  const Eigen::Quaterniond rotation =
      angle > 0.0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) : Eigen::Quaterniond::Identity();
  return {T_target_source.position + step.head<3>(), (rotation * T_target_source.rotation).normalized()};
}

Registration register_cloud(const SurfaceCloud& target, const SurfaceCloud& source, const Pose3& T_target_source_start,
                            const RegistrationSettings& settings) {
  Registration result{.T_target_source = T_target_source_start};
  const std::vector<std::size_t> sample = sample_of(source, settings.sample);
  double distance_m = std::max(settings.initial_pair_distance_m, settings.final_pair_distance_m);
  for (; result.iterations < settings.max_iterations && !result.converged; ++result.iterations) {
    Matrix6 H = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    std::size_t pairs = 0;
    const double kernel_m2 = distance_m * distance_m / 9.0;
    for (const std::size_t i : sample) {
      const auto pair = pair_of(target, source, i, result.T_target_source, distance_m);
      if (!pair) continue;
      Vector6 J;
      J << pair->normal, pair->arm.cross(pair->normal);
      const double root = kernel_m2 / (kernel_m2 + pair->residual_m * pair->residual_m), weight = root * root;
      H += weight * J * J.transpose();
      b += weight * pair->residual_m * J;
      ++pairs;
    }
    if (pairs < kMinPairs) return result;
    H.diagonal().array() += 1e-6 * H.trace();
    const Vector6 step = -solve_symmetric(H, b);
    result.T_target_source = apply_step(result.T_target_source, step);
    // Distant pairs need not converge completely before closer ones are used.
    const double length_m = step.head<3>().norm() + kRegistrationArm_m * step.tail<3>().norm();
    const bool is_last = distance_m <= settings.final_pair_distance_m;
    if (is_last) result.converged = length_m < settings.step_tolerance_m;
    else if (length_m < std::max(settings.step_tolerance_m, 0.02 * distance_m))
      distance_m = std::max(settings.final_pair_distance_m, 0.5 * distance_m);
  }
  double squares = 0.0;
  std::size_t kept = 0;
  for (const std::size_t i : sample) {
    const auto pair = pair_of(target, source, i, result.T_target_source, settings.final_pair_distance_m);
    if (!pair || std::abs(pair->residual_m) > settings.final_pair_distance_m) continue;
    squares += pair->residual_m * pair->residual_m;
    ++kept;
  }
  if (kept > 0) result.rms_m = std::sqrt(squares / static_cast<double>(kept));
  if (!sample.empty()) result.inlier_ratio = static_cast<double>(kept) / static_cast<double>(sample.size());
  return result;
}

}  // namespace patrol::inspect
