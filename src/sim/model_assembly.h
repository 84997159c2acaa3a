#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/robot_description.h"
#include "core/time.h"
#include "sim/mujoco.h"
#include "sim/robot_model.h"
#include "sim/static_obstacles.h"

namespace patrol::sim {

/// World and robot as two MuJoCo models with identical bodies, joints and mocap bodies in the same order. A state of
/// one model is a state of the other.
struct AssembledModel {
  ModelPtr physics;                ///< collision geometry only, so that scenery costs no physics time
  ModelPtr view;                   ///< complete geometry, for rendering and lidar
  std::vector<double> start_qpos;  ///< joint positions with the robot standing at the start pose
  Stance stance;                   ///< stance of `start_qpos`
};

/// Whether a model has the images of its textures. Only renders in color need them.
enum class Textures { kLoaded, kNone };

/// Adds the robot of a URDF, which `robot` describes, and static obstacles to the world of an MJCF file, with the robot
/// standing on the ground at `T_world_start`. Throws InputError when a file is invalid or the start pose is inside an
/// object.
AssembledModel assemble_model(const std::string& world_xml, const RobotUrdf& robot_urdf, const RobotDescription& robot,
                              const Pose2& T_world_start, const std::vector<StaticObstacleSettings>& obstacles = {},
                              Textures textures = Textures::kLoaded);

/// Returns the time step of the world of an MJCF file. Throws InputError when the file is invalid.
Time tick_of(const std::string& world_xml);

/// Returns the height of `base_link` in world, m, of a robot that stands at `T_world_start` in the world of an MJCF
/// file. Throws InputError when a file is invalid or no ground is below.
double start_height_m(const std::string& world_xml, const RobotUrdf& robot_urdf, const RobotDescription& robot,
                      const Pose2& T_world_start);

/// Returns the MJCF of a robot, which `robot` describes, on a plane, with the keyframe "standing" of its start posture.
/// It contains absolute paths of the robot's meshes. Throws InputError if the URDF is invalid.
std::string mjcf_of(const RobotUrdf& robot_urdf, const RobotDescription& robot);

/// Returns the height of the ground on which the robot stands with its base at `T_world_body`, m: that of the highest
/// collision surface below `max_ground_height_m` under any support point of its stance, or `kMaxStartDepth_m` below the
/// highest one under a foot, whichever is higher. The robot itself is ignored. Throws InputError if there is none.
double ground_height_m(const mjModel& model, const mjData& data, const Stance& stance, const Pose2& T_world_body,
                       double max_ground_height_m);

/// Sets the leg joints in `qpos` (nq) to the standing posture and changes nothing else.
void set_standing_posture(const mjModel& model, const RobotDescription& robot, mjtNum* qpos);

}  // namespace patrol::sim
