#include "core/leg_kinematics.h"

#include <cmath>

namespace patrol {

Eigen::Vector3d foot_position(const LegGeometry& leg, const Eigen::Vector3d& joint_rad) {
  const double hip = joint_rad[1], knee = joint_rad[2];
  // Foot in the plane of the leg, after the abduction joint: x forward, z up.
  const double x = -leg.thigh_m * std::sin(hip) - leg.shank_m * std::sin(hip + knee);
  const double z = -leg.thigh_m * std::cos(hip) - leg.shank_m * std::cos(hip + knee);
  const double c = std::cos(joint_rad[0]), s = std::sin(joint_rad[0]);
  const double y = leg.abduction_offset_m;
  return leg.hip_in_body + Eigen::Vector3d(x, c * y - s * z, s * y + c * z);
}

Eigen::Matrix3d foot_jacobian(const LegGeometry& leg, const Eigen::Vector3d& joint_rad) {
  const double hip = joint_rad[1], knee = joint_rad[2];
  const double x_knee = -leg.shank_m * std::cos(hip + knee), z_knee = leg.shank_m * std::sin(hip + knee);
  const double x_hip = -leg.thigh_m * std::cos(hip) + x_knee, z_hip = leg.thigh_m * std::sin(hip) + z_knee;
  const double z = -leg.thigh_m * std::cos(hip) - leg.shank_m * std::cos(hip + knee);
  const double c = std::cos(joint_rad[0]), s = std::sin(joint_rad[0]);
  const double y = leg.abduction_offset_m;
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = Eigen::Vector3d(0.0, -s * y - c * z, c * y - s * z);
  jacobian.col(1) = Eigen::Vector3d(x_hip, -s * z_hip, c * z_hip);
  jacobian.col(2) = Eigen::Vector3d(x_knee, -s * z_knee, c * z_knee);
  return jacobian;
}

std::optional<Eigen::Vector3d> joint_angles(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body) {
  const Eigen::Vector3d p = foot_in_body - leg.hip_in_body;
  const double offset = leg.abduction_offset_m;
  const double planar_squared = p.y() * p.y() + p.z() * p.z() - offset * offset;
  if (planar_squared < 0.0) return std::nullopt;
  // Remove the abduction: in the plane of the leg the foot is at (x, z) with z < 0.
  const double z = -std::sqrt(planar_squared);
  const double abduction = std::atan2(p.z(), p.y()) - std::atan2(z, offset);
  const double cos_knee = (p.x() * p.x() + z * z - leg.thigh_m * leg.thigh_m - leg.shank_m * leg.shank_m) /
                          (2.0 * leg.thigh_m * leg.shank_m);
  if (std::abs(cos_knee) > 1.0) return std::nullopt;
  const double knee = -std::acos(cos_knee);
  const double hip =
      std::atan2(-p.x(), -z) - std::atan2(leg.shank_m * std::sin(knee), leg.thigh_m + leg.shank_m * std::cos(knee));
  return Eigen::Vector3d(std::remainder(abduction, 2.0 * M_PI), hip, knee);
}

}  // namespace patrol
