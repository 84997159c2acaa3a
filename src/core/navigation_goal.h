#pragma once

#include "core/frames.h"

namespace patrol {

/// Yaw tolerance from which on any heading is accepted; below pi, so that a rounded pi is included.
inline constexpr double kAnyYawTolerance_rad = 3.0;

/// Goal pose of the navigation, with its tolerances.
struct NavigationGoal {
  Pose2 T_map_body;
  double position_tolerance_m = 0.05;
  /// From `kAnyYawTolerance_rad` on, any heading is accepted, and the robot does not turn in place at the goal.
  double yaw_tolerance_rad = 0.05;

  bool accepts_any_yaw() const { return yaw_tolerance_rad >= kAnyYawTolerance_rad; }

  friend bool operator==(const NavigationGoal& a, const NavigationGoal& b) {
    return a.T_map_body.x == b.T_map_body.x && a.T_map_body.y == b.T_map_body.y &&
           a.T_map_body.yaw == b.T_map_body.yaw && a.position_tolerance_m == b.position_tolerance_m &&
           a.yaw_tolerance_rad == b.yaw_tolerance_rad;
  }
};

}  // namespace patrol
