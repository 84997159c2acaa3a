#pragma once

#include "core/messages.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Whether the robot can move at a velocity for a time without collision in the costmap, or at least without reducing
/// the clearance.
bool is_motion_safe(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& command, double time_s);

}  // namespace patrol::plan
