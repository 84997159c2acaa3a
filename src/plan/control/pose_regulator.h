#pragma once

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/pose_regulator_settings.h"

namespace patrol::plan {

/// Controls the last half meter of a robot that can move sideways: straight to the goal position, turning to the goal
/// heading meanwhile.
VelocityCommand regulate_pose(const PoseRegulatorSettings& settings, const Pose2& T_map_body,
                              const NavigationGoal& goal);

/// Whether the pose is within the tolerances of the goal.
bool is_reached(const Pose2& T_map_body, const NavigationGoal& goal);

}  // namespace patrol::plan
