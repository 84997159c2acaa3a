#pragma once

#include <Eigen/Core>

#include <optional>

#include "core/robot_description.h"

namespace patrol {

/// Centre of the foot in body, m, for joint angles (abduction, hip, knee) in rad.
Eigen::Vector3d foot_position(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// d foot_position / d joint_rad, m/rad, in body.
Eigen::Matrix3d foot_jacobian(const LegGeometry& leg, const Eigen::Vector3d& joint_rad);

/// Joint angles that put the foot at `foot_in_body` with the knee bent backwards (knee angle < 0); none if out of reach.
std::optional<Eigen::Vector3d> joint_angles(const LegGeometry& leg, const Eigen::Vector3d& foot_in_body);

}  // namespace patrol
