#pragma once

#include "core/robot_description.h"
#include "sim/locomotion/locomotion_settings.h"

namespace patrol::sim {

/// Returns the highest speed of a joint in a swing, relative to the limit of the joint, while the robot walks straight
/// at `forward_mps` on level ground.
double peak_swing_speed_ratio(const RobotDescription& robot, const LocomotionSettings& settings, double forward_mps);

/// Lowers the swing and then the forward speed until the joints keep a tenth of their speed as a reserve. The swing
/// keeps at least 60 % of its clearance, the robot at least 0.1 m/s.
void limit_to_joint_speeds(const RobotDescription& robot, LocomotionSettings& settings);

}  // namespace patrol::sim
