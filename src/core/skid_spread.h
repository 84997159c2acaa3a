#pragma once

#include "core/robot_description.h"

namespace patrol {

/// Returns the standard deviation of the gauge ratio of skid_turn() (core/wheel_kinematics.h) for wheels whose radii
/// have independent errors with the standard deviation `radius_std`, relative to the radius. To first order, 0 for up
/// to four wheels, tracks and mecanum wheels: a rigid chassis on more than four wheels loads them by their radii.
/// `tire_deflection_ratio`: deflection of a tire under the mean load, relative to the radius.
double skid_ratio_std(const RobotDescription& robot, double radius_std, double tire_deflection_ratio);

}  // namespace patrol
