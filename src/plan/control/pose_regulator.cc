#include "plan/control/pose_regulator.h"

#include <algorithm>
#include <cmath>

namespace patrol::plan {

VelocityCommand regulate_pose(const PoseRegulatorSettings& settings, const Pose2& T_map_body,
                              const NavigationGoal& goal) {
  const Pose2 T_body_goal = T_map_body.inverse() * goal.T_map_body;
  const auto limited = [](double value, double limit) { return std::clamp(value, -limit, limit); };
  return {.stamp = {},
          .vx_mps = limited(settings.position_gain_per_s * T_body_goal.x, settings.max_speed_mps),
          .vy_mps = limited(settings.position_gain_per_s * T_body_goal.y, settings.max_lateral_speed_mps),
          .yaw_rate_radps = goal.accepts_any_yaw()
                                ? 0.0
                                : limited(settings.yaw_gain_per_s * T_body_goal.yaw, settings.max_yaw_rate_radps)};
}

bool is_reached(const Pose2& T_map_body, const NavigationGoal& goal) {
  const Pose2 T_body_goal = T_map_body.inverse() * goal.T_map_body;
  return T_body_goal.position().norm() <= goal.position_tolerance_m &&
         (goal.accepts_any_yaw() || std::abs(T_body_goal.yaw) <= goal.yaw_tolerance_rad);
}

}  // namespace patrol::plan
