#include "core/leg_kinematics.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/Geometry>

namespace patrol {

LegChainState chain_state(const LegChain& chain, const Eigen::Vector3d& joint_rad) {
  LegChainState state;
  Pose3 T_body_joint;
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const LegJoint& joint = chain.joints[i];
    T_body_joint = T_body_joint * joint.T_parent_joint;
    state.axis[i] = T_body_joint.rotation * joint.axis;
    state.position[i] = T_body_joint.position;
    T_body_joint.rotation =
        T_body_joint.rotation * Eigen::AngleAxisd(joint_rad[static_cast<Eigen::Index>(i)], joint.axis);
  }
  state.foot = T_body_joint * chain.foot;
  return state;
}

Eigen::Vector3d foot_position(const LegGeometry& leg, const Eigen::Vector3d& joint_rad) {
  if (leg.chain) return chain_state(*leg.chain, joint_rad).foot;
  const double hip = joint_rad[1], knee = joint_rad[2];
  // Foot in the plane of the leg, after the abduction joint: x forward, z up.
  const double x = -leg.thigh_m * std::sin(hip) - leg.shank_m * std::sin(hip + knee);
  const double z = -leg.thigh_m * std::cos(hip) - leg.shank_m * std::cos(hip + knee);
  const double c = std::cos(joint_rad[0]), s = std::sin(joint_rad[0]);
  const double y = leg.abduction_offset_m;
  return leg.hip_in_body + Eigen::Vector3d(x, c * y - s * z, s * y + c * z);
}

Eigen::Matrix3d foot_jacobian(const LegGeometry& leg, const Eigen::Vector3d& joint_rad) {
  Eigen::Matrix3d jacobian;
  if (leg.chain) {
    const LegChainState state = chain_state(*leg.chain, joint_rad);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto joint = static_cast<std::size_t>(i);
      jacobian.col(i) = state.axis[joint].cross(state.foot - state.position[joint]);
    }
    return jacobian;
  }
  const double hip = joint_rad[1], knee = joint_rad[2];
  const double x_knee = -leg.shank_m * std::cos(hip + knee), z_knee = leg.shank_m * std::sin(hip + knee);
  const double x_hip = -leg.thigh_m * std::cos(hip) + x_knee, z_hip = leg.thigh_m * std::sin(hip) + z_knee;
  const double z = -leg.thigh_m * std::cos(hip) - leg.shank_m * std::cos(hip + knee);
  const double c = std::cos(joint_rad[0]), s = std::sin(joint_rad[0]);
  const double y = leg.abduction_offset_m;
  jacobian.col(0) = Eigen::Vector3d(0.0, -s * y - c * z, c * y - s * z);
  jacobian.col(1) = Eigen::Vector3d(x_hip, -s * z_hip, c * z_hip);
  jacobian.col(2) = Eigen::Vector3d(x_knee, -s * z_knee, c * z_knee);
  return jacobian;
}

Eigen::Vector3d shank_rate(const LegGeometry& leg, const Eigen::Vector3d& joint_rad,
                           const Eigen::Vector3d& joint_radps) {
  if (leg.chain) {
    const LegChainState state = chain_state(*leg.chain, joint_rad);
    return joint_radps[0] * state.axis[0] + joint_radps[1] * state.axis[1] + joint_radps[2] * state.axis[2];
  }
  const Eigen::Vector3d pitch_axis(0.0, std::cos(joint_rad[0]), std::sin(joint_rad[0]));
  return joint_radps[0] * Eigen::Vector3d::UnitX() + (joint_radps[1] + joint_radps[2]) * pitch_axis;
}

std::optional<PlanarLegAngles> planar_leg_angles(double thigh_m, double shank_m, double x_m, double z_m,
                                                 bool is_knee_backward) {
  const double cos_knee = (x_m * x_m + z_m * z_m - thigh_m * thigh_m - shank_m * shank_m) / (2.0 * thigh_m * shank_m);
  if (!(std::abs(cos_knee) <= 1.0)) return std::nullopt;
  const double knee = is_knee_backward ? -std::acos(cos_knee) : std::acos(cos_knee);
  const double hip = std::atan2(-x_m, -z_m) - std::atan2(shank_m * std::sin(knee), thigh_m + shank_m * std::cos(knee));
  return PlanarLegAngles{.hip_rad = hip, .knee_rad = knee};
}

std::optional<Eigen::Vector3d> joint_angles(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body) {
  const Eigen::Vector3d p = foot_in_body - leg.hip_in_body;
  const double offset = leg.abduction_offset_m;
  const double planar_squared = p.y() * p.y() + p.z() * p.z() - offset * offset;
  if (planar_squared < 0.0) return std::nullopt;
  // Remove the abduction: in the plane of the leg the foot is at (x, z) with z < 0.
  const double z = -std::sqrt(planar_squared);
  const double abduction = std::atan2(p.z(), p.y()) - std::atan2(z, offset);
  const auto angles = planar_leg_angles(leg.thigh_m, leg.shank_m, p.x(), z, true);
  if (!angles) return std::nullopt;
  return Eigen::Vector3d(std::remainder(abduction, 2.0 * std::numbers::pi), angles->hip_rad, angles->knee_rad);
}

}  // namespace patrol
