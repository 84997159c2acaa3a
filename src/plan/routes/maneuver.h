#pragma once

#include <vector>

#include "core/frames.h"

namespace patrol::plan {

/// Pose on a maneuver of a robot that cannot turn in place. The point of the robot is its turn center: the middle of
/// the axle that is not steered.
struct ManeuverPose {
  Pose2 T_map_center;
  double curvature_per_m = 0.0;  ///< change of the yaw per meter driven, of the arc that leads here
  bool is_reverse = false;       ///< whether the robot drives backward to here
  double along_m = 0.0;          ///< distance driven from the start
};

/// Poses at most 0.1 m apart, from start to goal. Where the robot changes its direction, the pose is that of the end of
/// the first part; the first pose of the next part is one step further.
using Maneuver = std::vector<ManeuverPose>;

}  // namespace patrol::plan
