#pragma once

#include <string>
#include <utility>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/frames.h"
#include "core/robot_description.h"

namespace patrol::sim {

/// Groups of geoms (README, "Worlds").
inline constexpr int kGroupSolid = 0;  ///< scenery visible to cameras and lidar
inline constexpr int kGroupVisualOnly = 1;
inline constexpr int kGroupLidarOnly = 2;
inline constexpr int kGroupCollisionOnly = 3;
inline constexpr int kGroupRobotVisual = 4;
inline constexpr int kGroupRobotCollision = 5;

/// Collision bits of a robot. It collides with scenery only, which has contype 1 and conaffinity 2.
inline constexpr int kRobotContype = 2;
inline constexpr int kRobotConaffinity = 1;

/// Depth by which a robot may overlap with the scenery where it starts, m.
inline constexpr double kMaxStartDepth_m = 0.02;

/// Placement of a robot, upright on level ground.
struct Stance {
  double height_m = 0.0;                          ///< height of the base above the ground
  std::vector<Eigen::Vector2d> support_points_m;  ///< points at which the ground height is sampled, in level
  std::vector<Eigen::Vector2d> feet_m;  ///< feet: no ground below them is higher by `kMaxStartDepth_m`; in level
  double max_ground_height_m = 0.0;  ///< surfaces higher than this above the lowest floor are not ground at the start
};

/// URDF of a robot.
struct RobotUrdf {
  // NOLINTBEGIN(google-explicit-constructor): a file is the usual case
  RobotUrdf(std::string file = {}, std::string content = {}) : path(std::move(file)), text(std::move(content)) {}
  RobotUrdf(const char* file) : path(file) {}
  // NOLINTEND(google-explicit-constructor)

  std::string path;  ///< file, for messages and for the folder of its meshes
  std::string text;  ///< content with the mounts of the robot (io/urdf.h); empty: that of the file
};

/// Returns the stance of the robot of a URDF, which `robot` describes.
Stance to_stance(const RobotUrdf& urdf, const RobotDescription& robot);

/// Adds the robot of a URDF, which `robot` describes, to a world.
///
/// Bodies, inertias, joints and shapes come from the URDF; actuators, contact parameters and rotor inertias, which URDF
/// cannot express, come from here. The base gets a free joint at `T_world_body`. Names: bodies as links, joints and
/// their motors as joints, foot geoms as their links, sensor frames as sites.
void add_robot(mjSpec& world, const RobotUrdf& urdf, const RobotDescription& robot, const Pose3& T_world_body);

}  // namespace patrol::sim
