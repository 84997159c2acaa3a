#include "plan/navigation/motion_check.h"

#include <algorithm>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

bool is_motion_safe(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& command, double time_s,
                    double min_clearance_m) {
  const double clearance_now = costmap.clearance_m(T_map_body);
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    const Pose2 there = follow_arc(T_map_body, command.vx_mps, command.yaw_rate_radps, time_s * part, command.vy_mps);
    if (costmap.clearance_m(there) < std::min(min_clearance_m, clearance_now)) return false;
  }
  return true;
}

}  // namespace patrol::plan
