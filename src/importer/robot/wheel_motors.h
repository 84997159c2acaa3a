#pragma once

#include <cstddef>
#include <vector>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

inline constexpr double kFriction = 0.8;          // rubber on asphalt
inline constexpr double kMinSteering_rad = 0.05;  // to each side
inline constexpr double kSteering_rad = 0.6;      // to each side, of a joint without limits
inline constexpr double kAssumedSpeed_mps = 1.5;

/// Returns the torque and speed limits of a driven wheel.
Motor motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg, std::vector<Assumption>& rows);

/// Returns the speed of the robot at which a driven wheel reaches its limit. A limit that no robot of its size reaches
/// is taken for a missing one.
double speed_of(const FoundWheel& wheel, const Motor& motor, std::vector<Assumption>& rows);

/// Reduces damping and friction of a driven wheel that its motor cannot overcome at full speed, or that brake the robot
/// with more than the friction of the tires.
void reduce_losses(const FoundWheel& wheel, std::size_t num_driven, double mass_kg, NormalizedJoint& driven,
                   std::vector<Assumption>& rows);

/// Returns the range of a steering joint.
JointRange steering_range_of(const SourceRobot& source, const SourceJoint& joint, std::vector<Assumption>& rows);

/// Returns the torque and speed limits of the joint that steers a wheel, one of `num_wheels`.
Motor steering_motor_of(const FoundWheel& wheel, std::size_t num_wheels, double mass_kg, std::vector<Assumption>& rows);

}  // namespace patrol::importer
