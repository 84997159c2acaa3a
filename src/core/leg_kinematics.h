#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/robot_description.h"

namespace patrol {

/// Returns the center of the foot in body, m, for joint angles (abduction, hip, knee) in rad.
Eigen::Vector3d foot_position(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// Returns the Jacobian d foot_position / d joint_rad, m/rad, in body.
Eigen::Matrix3d foot_jacobian(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// Returns the joint angles that move the foot to `foot_in_body` with the knee bent backward (knee angle < 0); nullopt
/// if the position is out of reach.
std::optional<Eigen::Vector3d> joint_angles(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body);

}  // namespace patrol
