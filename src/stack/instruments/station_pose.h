#pragma once

#include "core/frames.h"

namespace patrol::stack {

/// Pose of the body at an instant: tilt and height above the ground, and pose in map.
struct StationPose {
  Pose3 T_level_body;
  Pose2 T_map_body;

  /// Returns the pose of `scanner_level` in map.
  Pose3 T_map_scanner(const Pose3& T_body_scanner) const {
    const Pose3 T_map_tilted = to_pose3(T_map_body) * T_level_body * T_body_scanner;
    return {T_map_tilted.position, quaternion_from_yaw(to_yaw(T_map_tilted.rotation))};
  }
};

}  // namespace patrol::stack
