#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "sim/mujoco.h"
#include "sim/props.h"
#include "sim/robot_model.h"

namespace patrol::sim {

/// World and robot as two MuJoCo models with the same bodies, joints and mocap bodies, in the same order:
/// a state of one is a state of the other.
struct AssembledModel {
  ModelPtr physics;  ///< only what can touch: scenery shall not cost physics
  ModelPtr view;     ///< everything: for renders and for the lidar
  std::vector<double> start_qpos;  ///< standing at the start pose
  Stance stance;                   ///< that of `start_qpos`
};

/// Puts the robot of a URDF and some props into the world of an MJCF file, the robot standing on the ground at `T_world_start`.
/// Throws InputError when a file is wrong or when the start pose is inside something.
AssembledModel assemble_model(const std::string& world_xml, const std::string& robot_urdf, const Pose2& T_world_start,
                              const std::vector<PropSettings>& props = {});

/// Height of what the robot would stand on with its base over `T_world_body`, m: the highest touchable surface under any point of
/// its stance, seen from `eye_height_m` downwards. The robot itself does not count. Throws InputError if there is none.
double ground_height_m(const mjModel& model, const mjData& data, const Stance& stance, const Pose2& T_world_body,
                       double eye_height_m);

/// The standing posture in which a robot with legs starts: abduction, hip, knee of each leg, rad.
inline constexpr double kStartPosture[3] = {0.0, 0.8, -1.6};

/// Sets the leg joints among `qpos` (nq) to it, and nothing else.
void put_legs_in_start_posture(const mjModel& model, mjtNum* qpos);

}  // namespace patrol::sim
