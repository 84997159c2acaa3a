#pragma once

#include <cstddef>

#include "core/robot_description.h"

namespace patrol::sim {

/// Returns a ratio without the rounding errors of a description, so that the tuned robot has exactly 1.
double rounded_to_percent(double ratio);

/// Ratios of a robot with legs to the robot for which the gains are tuned.
struct LegScale {
  double length = 1.0;
  double time = 1.0;   ///< square root of `length`: equal Froude numbers
  double force = 1.0;  ///< ratio of the masses, rounded to 1 %
};

LegScale leg_scale(const RobotDescription& robot);

/// Returns the torque of the motor of a joint relative to the robot for which the gains are tuned, for its rotor
/// inertia and friction. It is at most three times the ratio of weight times leg length, about the weight at the length
/// of a leg: some descriptions have an `effort` such as 1000 N m, whose friction exceeds the torques of the gait.
double motor_ratio(const RobotDescription& robot, std::size_t joint);

}  // namespace patrol::sim
