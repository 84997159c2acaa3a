#pragma once

#include "core/frames.h"

namespace patrol {

/// Where the mission wants the robot to stand, and how exactly.
struct NavigationGoal {
  Pose2 T_map_body;
  double position_tol_m = 0.05;
  double yaw_tol_rad = 0.05;  ///< pi: any heading will do, and the robot need not stop to turn

  friend bool operator==(const NavigationGoal& a, const NavigationGoal& b) {
    return a.T_map_body.vector() == b.T_map_body.vector() && a.position_tol_m == b.position_tol_m &&
           a.yaw_tol_rad == b.yaw_tol_rad;
  }
};

}  // namespace patrol
