#include "sim/locomotion/force_distribution.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "core/geometry/linear_algebra.h"

namespace patrol::sim {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Vector3d inside_pyramid(Eigen::Vector3d force, const FrictionLimits& limits) {
  force.z() = std::clamp(force.z(), limits.min_normal_n, limits.max_normal_n);
  const double bound = limits.coefficient * force.z();
  force.x() = std::clamp(force.x(), -bound, bound);
  force.y() = std::clamp(force.y(), -bound, bound);
  return force;
}

// f = G^T (G G^T + ridge)^-1 w: the minimum-norm forces for the wrench w. Two feet cannot exert a moment about the line
// between them; the ridge suppresses that component.
FootVectors minimum_norm_forces(const Vector6& wrench, const FootVectors& feet, const FootFlags& is_stance) {
  Matrix6 gram = Matrix6::Zero();
  FootVectors forces;
  forces.fill(Eigen::Vector3d::Zero());
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (!is_stance[leg]) continue;
    const Eigen::Matrix3d cross = cross_matrix(feet[leg]);
    gram.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
    gram.topRightCorner<3, 3>() += cross.transpose();
    gram.bottomLeftCorner<3, 3>() += cross;
    gram.bottomRightCorner<3, 3>() += cross * cross.transpose();
  }
  constexpr double kForceRidge = 1e-4, kMomentRidge = 1e-4;
  gram.diagonal().head<3>().array() += kForceRidge;
  gram.diagonal().tail<3>().array() += kMomentRidge;
  const Vector6 multiplier = solve_symmetric(gram, wrench);
  const Eigen::Vector3d pull = multiplier.head<3>(), twist = multiplier.tail<3>();
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (is_stance[leg]) forces[leg] = pull + twist.cross(feet[leg]);
  }
  return forces;
}

FootVectors inside_pyramids(FootVectors forces, const FootFlags& is_stance, const FrictionLimits& limits) {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (is_stance[leg]) forces[leg] = inside_pyramid(forces[leg], limits);
  }
  return forces;
}

/// Returns forces with the feet that would pull at their minimum, and the minimum-norm forces of at least two others
/// for the rest of the wrench: the active set method for the lower bounds of the normal forces.
FootVectors without_pulling_feet(Vector6 wrench, const FootVectors& feet, const FootFlags& is_stance,
                                 const FrictionLimits& limits) {
  FootFlags is_free = is_stance;
  FootVectors held;
  held.fill(Eigen::Vector3d::Zero());
  while (true) {
    FootVectors forces = minimum_norm_forces(wrench, feet, is_free);
    bool is_changed = false;
    for (int leg = 0; leg < kNumLegs; ++leg) {
      const bool is_pulling = is_free[leg] && forces[leg].z() < limits.min_normal_n;
      if (!is_pulling || std::ranges::count(is_free, true) <= 2) continue;
      is_free[leg] = false;
      is_changed = true;
      held[leg] = {0.0, 0.0, limits.min_normal_n};
      wrench.head<3>() -= held[leg];
      wrench.tail<3>() -= feet[leg].cross(held[leg]);
    }
    if (is_changed) continue;
    for (int leg = 0; leg < kNumLegs; ++leg) forces[leg] += held[leg];
    return inside_pyramids(forces, is_stance, limits);
  }
}

}  // namespace

FootVectors distribute_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, const FootVectors& feet,
                              const FootFlags& is_stance, const FrictionLimits& limits) {
  Vector6 wrench;
  wrench << force, moment;
  if (limits.redistributes) return without_pulling_feet(wrench, feet, is_stance, limits);
  return inside_pyramids(minimum_norm_forces(wrench, feet, is_stance), is_stance, limits);
}

}  // namespace patrol::sim
