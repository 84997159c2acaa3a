#pragma once

#include "core/messages.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Whether the robot can move at a constant velocity in body for a time with a minimum clearance in the costmap, or at
/// least without reducing the clearance. The pose is tested at four times on the arc.
bool is_motion_safe(const Costmap& costmap, const Pose2& T_map_body, const VelocityCommand& command, double time_s,
                    double min_clearance_m = kMinPassable_m);

}  // namespace patrol::plan
