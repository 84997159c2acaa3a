#include "plan/control/rollouts/rollout.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::plan {

Pose2 follow_arc(const Pose2& T_map_body, double vx_mps, double yaw_rate_radps, double time_s, double vy_mps) {
  const double turn = yaw_rate_radps * time_s;
  const double distance_m = vx_mps * time_s;
  // sin(turn)/turn and (1 - cos(turn))/turn, with their limits at 0.
  const bool is_straight = std::abs(turn) < 1e-6;
  const double along = is_straight ? distance_m : distance_m * std::sin(turn) / turn;
  const double aside = is_straight ? distance_m * turn / 2.0 : distance_m * (1.0 - std::cos(turn)) / turn;
  if (vy_mps == 0.0) return T_map_body * Pose2{along, aside, turn};
  const Pose2 lateral = follow_arc({}, vy_mps, yaw_rate_radps, time_s);  // the arc of a forward motion, turned left
  return T_map_body * Pose2{along - lateral.y, aside + lateral.x, turn};
}

Rollout roll_out(const Costmap& costmap, const Pose2& T_map_body, double vx_mps, double yaw_rate_radps,
                 double horizon_s, int steps, double vy_mps, bool until_contact) {
  Rollout rollout{
      .vx_mps = vx_mps, .yaw_rate_radps = yaw_rate_radps, .vy_mps = vy_mps, .T_map_body = {}, .min_clearance_m = 0.0};
  rollout.min_clearance_m = std::numeric_limits<double>::infinity();
  rollout.T_map_body.reserve(static_cast<std::size_t>(steps));
  for (int step = 1; step <= steps; ++step) {
    const double time_s = horizon_s * step / steps;
    rollout.T_map_body.push_back(follow_arc(T_map_body, vx_mps, yaw_rate_radps, time_s, vy_mps));
    rollout.min_clearance_m = std::min(rollout.min_clearance_m, costmap.clearance_m(rollout.T_map_body.back()));
    if (until_contact && rollout.min_clearance_m <= 0.0) break;
  }
  return rollout;
}

}  // namespace patrol::plan
