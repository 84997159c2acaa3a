#pragma once

#include <vector>

#include <Eigen/Core>

namespace patrol {

/// Waypoint of a teleoperated drive.
struct TeleopWaypoint {
  /// Position, m, in a frame named by the user of the struct (site or world).
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
  bool is_reverse = false;   ///< approach in reverse
  bool is_goal = false;      ///< stop here, turn to the heading, save the pose as a goal
  double heading_rad = 0.0;  ///< heading of the saved goal
};

using TeleopRoute = std::vector<TeleopWaypoint>;

}  // namespace patrol
