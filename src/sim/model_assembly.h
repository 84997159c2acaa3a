#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "sim/mujoco.h"

namespace patrol::sim {

/// World and robot as two MuJoCo models with the same bodies, joints and mocap bodies, in the same order:
/// a state of one is a state of the other.
struct AssembledModel {
  ModelPtr physics;  ///< only what can touch: scenery shall not cost physics
  ModelPtr view;     ///< everything: for renders and for the lidar
  std::vector<double> start_qpos;  ///< standing at the start pose
};

/// Puts the robot of a URDF into the world of an MJCF file, its feet on the ground at `T_world_start`.
/// Throws InputError when a file is wrong or when the start pose is inside something.
AssembledModel assemble_model(const std::string& world_xml, const std::string& robot_urdf, const Pose2& T_world_start);

/// The standing posture in which the robot starts: abduction, hip, knee of each leg, rad.
inline constexpr double kStartPosture[3] = {0.0, 0.8, -1.6};

}  // namespace patrol::sim
