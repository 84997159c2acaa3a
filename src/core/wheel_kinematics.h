#pragma once

#include <optional>
#include <vector>

#include "core/robot_description.h"

namespace patrol {

/// Drive of a wheeled robot, by its wheels.
enum class WheelDriveType {
  kDifferential,  ///< the sides turn at different speeds: two driven wheels with casters, or skid steering
  kAckermann,     ///< wheels on steering joints
};

/// Returns the type of drive. Throws InputError for a robot without driven wheels on both sides.
WheelDriveType wheel_drive_type(const RobotDescription& robot);

/// Left and right wheels or tracks that are not steered. Their mean speed is the forward speed of the turn center.
struct DifferentialGeometry {
  double gauge_m = 0.0;           ///< distance between the center lines of the two sides
  double contact_length_m = 0.0;  ///< distance between the first and the last contact of a side with the ground
  double rolling_radius_m = 0.0;  ///< mean wheel radius, or pitch radius of the sprockets
  double turn_center_x_m = 0.0;   ///< longitudinal position in body of the point that moves straight ahead in a turn
};

/// Returns the geometry of the tracks, or of the wheels that are not steered and, if any of these is driven, driven.
/// Throws InputError for a robot with neither.
DifferentialGeometry differential_geometry(const RobotDescription& robot);

/// Returns the ratio of the gauge of a differential drive without slip to the geometric gauge, for the same wheel
/// speeds and yaw rate: 1 for two driven wheels, more for skid steering.
///
/// Closed form of Coulomb friction on level ground: all wheels carry the same load, and the moment of their friction
/// about the turn center is zero. For four wheels it is 1 + (wheelbase / gauge)^2. The ratio depends neither on the
/// friction coefficient nor on the speed.
double skid_ratio(const RobotDescription& robot);

/// Set points of the joints of a wheeled robot, [joint] as in `RobotDescription::joint_names`.
struct WheelCommand {
  std::vector<double> speed_radps;  ///< driven wheels; 0 for steering joints
  std::vector<double> angle_rad;    ///< steering joints; 0 for driven wheels
};

/// Returns the wheel speeds and steering angles of a planar motion: forward speed and yaw rate at the turn center.
///
/// Steered wheels point along their velocity in the plane; the yaw rate is reduced until every steering angle is within
/// the limits of its joint. If the robot stands, the steering angles are those of `last_angle_rad` [joint].
/// `effective_gauge_ratio` multiplies the gauge of a differential drive (`skid_ratio`).
WheelCommand wheel_command(const RobotDescription& robot, double forward_mps, double yaw_rate_radps,
                           double effective_gauge_ratio, const std::vector<double>& last_angle_rad);

/// Returns the minimum turning radius of the turn center, m: 0 for a robot that turns in place.
double min_turning_radius_m(const RobotDescription& robot);

}  // namespace patrol
