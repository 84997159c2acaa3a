#include "plan/control/line_following.h"

#include <algorithm>
#include <cmath>

namespace patrol::plan {

double line_heading_rad(const LineFollowingSettings& settings, double lateral_m, double speed_mps) {
  const double angle = std::atan(settings.lateral_gain_per_m * lateral_m);
  return -std::copysign(1.0, speed_mps) * std::clamp(angle, -settings.max_angle_rad, settings.max_angle_rad);
}

VelocityCommand follow_line(const LineFollowingSettings& settings, const Pose2& T_line_body, double speed_mps) {
  const double turn = wrap_angle(line_heading_rad(settings, T_line_body.y, speed_mps) - T_line_body.yaw);
  const double yaw_rate = settings.yaw_gain_per_s * turn;
  return {.stamp = {},
          .vx_mps = speed_mps * std::max(0.0, std::cos(turn)),
          .vy_mps = 0.0,
          .yaw_rate_radps = std::clamp(yaw_rate, -settings.max_yaw_rate_radps, settings.max_yaw_rate_radps)};
}

double lateral_error_after_m(const LineFollowingSettings& settings, double lateral_m, double distance_m) {
  const double slope = std::tan(settings.max_angle_rad);
  const double knee_m = slope / settings.lateral_gain_per_m;  // lateral error below which the angle is not limited
  const double straight_m = std::max(0.0, (std::abs(lateral_m) - knee_m) / slope);
  if (distance_m <= straight_m) return std::abs(lateral_m) - slope * distance_m;
  const double from_m = std::min(std::abs(lateral_m), knee_m);
  return from_m * std::exp(-settings.lateral_gain_per_m * (distance_m - straight_m));
}

}  // namespace patrol::plan
