#pragma once

#include "core/frames.h"

namespace patrol {

/// Goal pose of the navigation, with its tolerances.
struct NavigationGoal {
  Pose2 T_map_body;
  double position_tol_m = 0.05;
  double yaw_tol_rad = 0.05;  ///< pi: any heading is accepted, and the robot does not turn in place at the goal

  friend bool operator==(const NavigationGoal& a, const NavigationGoal& b) {
    return a.T_map_body.vector() == b.T_map_body.vector() && a.position_tol_m == b.position_tol_m &&
           a.yaw_tol_rad == b.yaw_tol_rad;
  }
};

}  // namespace patrol
