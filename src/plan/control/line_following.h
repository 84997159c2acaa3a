#pragma once

#include "core/frames.h"
#include "core/messages.h"
#include "core/settings.h"
#include "plan/control/line_following_settings.h"

namespace patrol::plan {

/// Drives a robot that cannot move sideways along the x axis of `line`, forward or backward (negative speed). The
/// heading setpoint is tan(angle) = -gain y, so that dy/dx = -gain y. The lateral error falls with the distance driven,
/// independent of the speed: y(x) = y(0) exp(-gain |x|). Backward, the angle is mirrored.
VelocityCommand follow_line(const LineFollowingSettings& settings, const Pose2& T_line_body, double speed_mps);

/// Heading setpoint of `follow_line` relative to the line.
double line_heading_rad(const LineFollowingSettings& settings, double lateral_m, double speed_mps);

/// Lateral error after driving `distance_m` along the line: the law of `follow_line` with the limit on its angle.
double lateral_error_after_m(const LineFollowingSettings& settings, double lateral_m, double distance_m);

}  // namespace patrol::plan
