#pragma once

#include <Eigen/Core>

#include <vector>

namespace patrol {

/// A place that a drive by remote control goes through.
struct DriveWaypoint {
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< in the frame that the text says (site, world)
  bool is_reverse = false;    ///< driven to backwards
  bool is_mark = false;       ///< stop here, turn to the heading, mark the place as a goal
  double heading_rad = 0.0;   ///< of a mark
};

using RemoteDrive = std::vector<DriveWaypoint>;

}  // namespace patrol
