#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "core/robot_description.h"

namespace patrol {

/// Joints and foot of a chain in one posture, in body.
struct LegChainState {
  std::array<Eigen::Vector3d, 3> axis = {};        ///< unit vectors, [joint]
  std::array<Eigen::Vector3d, 3> position = {};    ///< m, [joint]
  Eigen::Vector3d foot = Eigen::Vector3d::Zero();  ///< center of the foot, m
};

LegChainState chain_state(const LegChain& chain, const Eigen::Vector3d& joint_rad);

/// Returns the center of the foot in body, m, for joint angles in rad, from the body to the foot (abduction, hip,
/// knee).
Eigen::Vector3d foot_position(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// Returns the Jacobian d foot_position / d joint_rad, m/rad, in body.
Eigen::Matrix3d foot_jacobian(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// Returns the angular velocity of the shank relative to the body, in body, for joint rates in rad/s.
Eigen::Vector3d shank_rate(const LegGeometry& leg, const Eigen::Vector3d& joint_rad,
                           const Eigen::Vector3d& joint_radps);

/// Angles of the hip and the knee of a leg in its plane.
struct PlanarLegAngles {
  double hip_rad = 0.0;   ///< angle of the thigh from the vertical, positive backward
  double knee_rad = 0.0;  ///< angle of the shank relative to the thigh; negative: the knee points backward
};

/// Returns the angles with which a thigh and a shank reach a foot at `x_m` in front of and `z_m` above the hip, with
/// the knee bent backward or forward; nullopt if it is out of reach.
std::optional<PlanarLegAngles> planar_leg_angles(double thigh_m, double shank_m, double x_m, double z_m,
                                                 bool is_knee_backward);

/// Returns the joint angles that move the foot to `foot_in_body` with the knee bent backward (knee angle < 0); nullopt
/// if the position is out of reach. The leg must have no `chain`.
std::optional<Eigen::Vector3d> joint_angles(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body);

}  // namespace patrol
