#pragma once

#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planned_path.h"

namespace patrol::plan {

/// Where a constant command leads.
struct Rollout {
  double vx_mps = 0.0;
  double yaw_rate_radps = 0.0;
  std::vector<Pose2> T_map_body;  ///< at equal steps of time, the present pose left out
  double min_clearance_m = 0.0;   ///< around the robot's outline, over all poses
};

/// What the costs judge a rollout by.
struct RolloutScene {
  const PlannedPath& path;
  double along_m = 0.0;        ///< where on the path the robot is
  double reach_m = 0.0;        ///< how far it could get within the horizon
  Twist3 twist;                ///< now, in body
  double max_speed_mps = 0.0;
  double max_yaw_rate_radps = 0.0;
};

/// The robot after moving at constant velocity for a time: an arc, or a turn in place.
Pose2 follow_arc(const Pose2& T_map_body, double vx_mps, double yaw_rate_radps, double time_s);

/// A constant command followed for `horizon_s` in `steps` equal steps.
Rollout roll_out(const Costmap& costmap, const Pose2& T_map_body, double vx_mps, double yaw_rate_radps, double horizon_s,
                 int steps);

}  // namespace patrol::plan
