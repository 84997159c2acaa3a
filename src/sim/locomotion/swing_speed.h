#pragma once

#include "core/robot_description.h"
#include "sim/locomotion/locomotion_settings.h"

namespace patrol::sim {

/// Returns the highest speed of a joint in a swing, relative to the limit of the joint, while the robot walks straight
/// at `forward_mps` on level ground.
double peak_swing_speed_ratio(const RobotDescription& robot, const LocomotionSettings& settings, double forward_mps);

/// Adapts the gait until the joints keep a tenth of their speed as a reserve: lowers the swing by up to 40 %, then
/// lengthens the period by up to 50 % for 35 % of the forward speed, then lowers the forward speed to 0.1 m/s or more.
void limit_to_joint_speeds(const RobotDescription& robot, LocomotionSettings& settings);

}  // namespace patrol::sim
