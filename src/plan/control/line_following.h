#pragma once

#include "core/frames.h"
#include "core/messages.h"
#include "core/settings.h"

namespace patrol::plan {

struct LineFollowingSettings {
  double lateral_gain_per_m = 3.0;   ///< inverse of the distance over which the lateral error falls to 1/e
  double max_angle_rad = 0.5;     ///< maximum angle toward the line
  double yaw_gain_per_s = 2.0;
  double max_yaw_rate_radps = 0.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lateral_gain_per_m", self.lateral_gain_per_m, between(0.1, 20.0));
    visit("max_angle_rad", self.max_angle_rad, between(0.05, 1.2));
    visit("yaw_gain_per_s", self.yaw_gain_per_s, between(0.1, 10.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.02, 3.0));
  }
};

/// Drives a robot that cannot move sideways along the x axis of `line`, forward or backward (negative speed). The
/// heading setpoint is tan(angle) = -gain y, so that dy/dx = -gain y. The lateral error falls with the distance driven,
/// independent of the speed: y(x) = y(0) exp(-gain |x|). Backward, the angle is mirrored.
VelocityCommand follow_line(const LineFollowingSettings& settings, const Pose2& T_line_body, double speed_mps);

/// Heading setpoint of `follow_line` relative to the line.
double line_heading_rad(const LineFollowingSettings& settings, double lateral_m, double speed_mps);

/// Lateral error after driving `distance_m` along the line: the law of `follow_line` with the limit on its angle.
double lateral_error_after_m(const LineFollowingSettings& settings, double lateral_m, double distance_m);

}  // namespace patrol::plan
