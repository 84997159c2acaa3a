#pragma once

#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Trajectory of a constant command.
struct Rollout {
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double vy_mps = 0.0;            ///< lateral velocity, positive to the left
  std::vector<Pose2> T_map_body;  ///< poses at equal time steps, without the current pose
  double min_clearance_m = 0.0;   ///< minimum clearance of the robot's outline over all poses
};

/// Inputs that all cost terms of a rollout share.
struct RolloutScene {
  const PlannedPath& path;
  double along_m = 0.0;               ///< position of the robot along the path
  double reachable_distance_m = 0.0;  ///< maximum distance that the robot can drive within the horizon
  Twist3 twist;                       ///< current twist, in body
  double max_speed_mps = 0.0;
  double max_yaw_rate_radps = 0.0;
  double max_lateral_speed_mps = 0.0;  ///< 0: no lateral motion
};

/// Pose after moving at constant velocity in body for a time: an arc, or a turn in place.
Pose2 follow_arc(const Pose2& T_map_body, double vx_mps, double yaw_rate_radps, double time_s, double vy_mps = 0.0);

/// Simulates a constant command for `horizon_s` in `steps` equal steps. With `until_contact`, the rollout ends with the
/// first pose without clearance.
Rollout roll_out(const Costmap& costmap, const Pose2& T_map_body, double vx_mps, double yaw_rate_radps,
                 double horizon_s, int steps, double vy_mps = 0.0, bool until_contact = false);

}  // namespace patrol::plan
