#pragma once

#include "core/frames.h"
#include "core/messages.h"
#include "core/settings.h"

namespace patrol::plan {

struct LineFollowingSettings {
  double side_gain_per_m = 3.0;   ///< the robot is 1/e as far beside the line after the inverse of this
  double max_angle_rad = 0.5;     ///< steepest way towards the line
  double yaw_gain_per_s = 2.0;
  double max_yaw_rate_radps = 0.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("side_gain_per_m", self.side_gain_per_m, between(0.1, 20.0));
    visit("max_angle_rad", self.max_angle_rad, between(0.05, 1.2));
    visit("yaw_gain_per_s", self.yaw_gain_per_s, between(0.1, 10.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.02, 3.0));
  }
};

/// Drives a robot that cannot step sideways along the x axis of `line`, forwards or backwards (negative speed). The heading
/// aimed at leads towards the line, tan(angle) = -gain y, so that dy/dx = -gain y: the side error falls by the way driven,
/// however slow that is, y(x) = y(0) exp(-gain |x|). Backwards the angle is mirrored.
VelocityCommand follow_line(const LineFollowingSettings& settings, const Pose2& T_line_body, double speed_mps);

/// The angle to the line that `follow_line` aims at.
double line_heading_rad(const LineFollowingSettings& settings, double side_m, double speed_mps);

/// How far beside the line the robot will be after driving `way_m` along it: the law above with the limit on its angle.
double side_after_m(const LineFollowingSettings& settings, double side_m, double way_m);

}  // namespace patrol::plan
