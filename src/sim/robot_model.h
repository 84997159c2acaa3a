#pragma once

#include <string>

#include <mujoco/mujoco.h>

#include "core/frames.h"

namespace patrol::sim {

/// Groups of geoms (README, "Worlds").
inline constexpr int kGroupSolid = 0;        ///< scenery that eye and lidar see
inline constexpr int kGroupEyeOnly = 1;
inline constexpr int kGroupLidarOnly = 2;
inline constexpr int kGroupTouchOnly = 3;
inline constexpr int kGroupRobotVisual = 4;
inline constexpr int kGroupRobotCollision = 5;

/// Adds the robot of a URDF to a world: bodies, inertias, joints and shapes from the file; what URDF cannot say
/// (actuators, contact parameters, rotor inertia) from here. The base gets a free joint at `T_world_body`.
/// Names: bodies as links, joints as joints, one motor per joint with the joint's name, feet's geoms as their links,
/// sensor frames as sites.
void add_robot(mjSpec& world, const std::string& urdf_path, const Pose3& T_world_body);

}  // namespace patrol::sim
