#pragma once

#include <cstddef>
#include <optional>

#include "core/site/map_in_site.h"
#include "core/trajectory.h"
#include "score/pose/trajectory_error.h"

namespace patrol::score {

/// Error of the pose in the survey frame, and of the registration of the map to it. `site` is world.
struct SiteScore {
  TrajectoryError pose;           ///< error of the path as the robot places it in site
  Pose2 T_site_map;               ///< last registration; the surveyed start in logs without one
  double position_error_m = 0.0;  ///< RMS distance by which the registration's error moves the driven path
  double yaw_error_deg = 0.0;     ///< absolute value
  std::optional<double> nees;     ///< normalized squared error of x, y, yaw; 3 is expected. None without registration
  std::size_t num_registrations = 0;
};

/// True pose of the map's frame: the planar motion that fits the positions of the estimated path best to the ground
/// truth, every 0.25 m. It is insensitive to a constant yaw between body and map, such as the mounting yaw of the
/// lidar. For a path inside a circle of 2 m it is the alignment at the start. A bent map has no exact frame, and the
/// poses are those that the robot estimated online.
Pose2 fit_map_frame(const Trajectory& T_map_body, const Trajectory& T_world_body);

/// Evaluates the estimated path and the last registration. Throws InputError when the trajectories do not overlap in
/// time.
SiteScore site_score(const Trajectory& T_map_body, const MapInSite& map, const Trajectory& T_world_body);

}  // namespace patrol::score
