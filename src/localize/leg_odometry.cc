#include "localize/leg_odometry.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/leg_kinematics.h"

namespace patrol::localize {

ContactWeights ContactDetector::update(Time stamp, const std::array<double, kNumLegs>& force_n) {
  ContactWeights weights{};
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    const bool was_loaded = is_loaded_[leg];
    is_loaded_[leg] = force_n[leg] > (was_loaded ? settings_.contact_off_n : settings_.contact_on_n);
    if (is_loaded_[leg] && !was_loaded) loaded_since_[leg] = stamp;
    const bool has_settled = is_loaded_[leg] && to_seconds(stamp - loaded_since_[leg]) >= settings_.settling_time_s;
    weights[leg] = has_settled ? std::clamp(force_n[leg] / settings_.full_weight_n, 0.0, 1.0) : 0.0;
  }
  return weights;
}

StanceFoot stance_foot(const LegGeometry& leg, int index, const LegSample& sample, const Eigen::Vector3d& up_in_body) {
  const Eigen::Vector3d angle = sample.angle_rad.col(index);
  const Eigen::Vector3d speed = sample.speed_radps.col(index);
  const Eigen::Vector3d center_to_contact = -leg.foot_radius_m * up_in_body;
  return {.leg = index,
          .p_contact = foot_position(leg, angle) + center_to_contact,
          .v_contact = foot_jacobian(leg, angle) * speed + shank_rate(leg, angle, speed).cross(center_to_contact)};
}

std::optional<LegVelocity> fuse_feet(const StanceFeet& feet, const Eigen::Vector3d& omega_body,
                                     const Eigen::Vector3d& v_expected, double foot_std_mps, double slip_mps) {
  LegVelocity fused;
  double weight_sum = 0.0;
  for (const StanceFoot& foot : feet) {
    const Eigen::Vector3d v_body = -(foot.v_contact + omega_body.cross(foot.p_contact));
    const double disagreement = (v_body - v_expected).norm() / slip_mps;
    const double weight = foot.weight / std::max(1.0, disagreement * disagreement);
    if (disagreement > 1.0) ++fused.num_slipping;
    fused.v_body += weight * v_body;
    fused.p_contact += weight * foot.p_contact;
    weight_sum += weight;
  }
  if (weight_sum <= 0.0) return std::nullopt;
  fused.v_body /= weight_sum;
  fused.p_contact /= weight_sum;
  fused.variance = foot_std_mps * foot_std_mps / weight_sum;
  return fused;
}

std::optional<double> yaw_rate_from_feet(const StanceFeet& feet) {
  if (feet.count < 2) return std::nullopt;
  Eigen::Vector2d p_mean = Eigen::Vector2d::Zero(), v_mean = Eigen::Vector2d::Zero();
  for (const StanceFoot& foot : feet) {
    p_mean += foot.p_contact.head<2>() / feet.count;
    v_mean += foot.v_contact.head<2>() / feet.count;
  }
  // For feet at rest on the ground, the rotation seen from the trunk is opposite to that of the trunk.
  double moment = 0.0, inertia = 0.0;
  for (const StanceFoot& foot : feet) {
    const Eigen::Vector2d p = foot.p_contact.head<2>() - p_mean, v = foot.v_contact.head<2>() - v_mean;
    moment -= p.x() * v.y() - p.y() * v.x();
    inertia += p.squaredNorm();
  }
  if (inertia <= 0.0) return std::nullopt;
  return moment / inertia;
}

std::optional<double> height_from_feet(const StanceFeet& feet, const Eigen::Vector3d& up_in_body) {
  double sum = 0.0, weight_sum = 0.0;
  for (const StanceFoot& foot : feet) {
    sum -= foot.weight * foot.p_contact.dot(up_in_body);
    weight_sum += foot.weight;
  }
  if (weight_sum <= 0.0) return std::nullopt;
  return sum / weight_sum;
}

}  // namespace patrol::localize
