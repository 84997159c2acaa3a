#pragma once

#include "core/robot_description.h"
#include "sim/locomotion/locomotion_settings.h"

namespace patrol::sim {

/// Returns the highest speed of a joint in a swing, relative to the limit of the joint, while the robot walks straight
/// at `forward_mps` on level ground.
double peak_swing_speed_ratio(const RobotDescription& robot, const LocomotionSettings& settings, double forward_mps);

/// Returns the lowest clearance to which `limit_to_joint_speeds` lowers the swing of a robot.
double min_swing_clearance_m(const RobotDescription& robot);

/// Returns the clearance of a swing foot that steps of 3 cm require: 8 cm, at most 27 % of the length of a leg.
/// Obstacles do not scale with the robot, and the feet lag behind their trajectory.
double step_clearance_m(const RobotDescription& robot);

/// Adapts the gait until the joints keep a tenth of their speed as a reserve: lowers the swing by up to 40 %, then
/// lengthens the period by up to 50 % for 35 % of the forward speed, then lowers the forward speed to 0.1 m/s or more.
/// Last, unless the joints are still too slow, raises the swing to `step_clearance_m`, or until
/// `peak_swing_speed_ratio` is 1.4. The feet lag behind such a swing: the joints reach half of the computed speed. The
/// forward speed is lower in the ratio of the clearances.
void limit_to_joint_speeds(const RobotDescription& robot, LocomotionSettings& settings);

}  // namespace patrol::sim
