#pragma once

#include <string>
#include <vector>

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

/// A robot touches scenery only, which has contype 1 and conaffinity 2.
inline constexpr int kRobotContype = 2;
inline constexpr int kRobotConaffinity = 1;

/// How a robot is put down, upright on level ground.
struct Stance {
  double height_m = 0.0;                   ///< of the base above the ground
  std::vector<Eigen::Vector2d> support_m;  ///< where the ground's height is taken, in level
  double eye_height_m = 0.0;               ///< what is higher than this, in world, is not for standing on at the start
};

Stance stance_of(const std::string& urdf_path);

/// Adds the robot of a URDF to a world: bodies, inertias, joints and shapes from the file; what URDF cannot say
/// (actuators, contact parameters, rotor inertia) from here. The base gets a free joint at `T_world_body`.
/// Names: bodies as links, joints as joints, one motor per joint with the joint's name, feet's geoms as their links,
/// sensor frames as sites.
void add_robot(mjSpec& world, const std::string& urdf_path, const Pose3& T_world_body);

}  // namespace patrol::sim
