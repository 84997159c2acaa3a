#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/robot_description.h"

namespace patrol {

/// Drive of a wheeled robot, by its wheels.
enum class WheelDriveType {
  kDifferential,  ///< the sides turn at different speeds: two driven wheels with casters, or skid steering
  kAckermann,     ///< wheels on steering joints
  kMecanum,       ///< four wheels with rollers at an angle to the axle
};

/// Pattern of the axes of the upper rollers of four mecanum wheels, seen from above. The axes of the lower rollers, on
/// the ground, form the other pattern.
enum class RollerPattern {
  kX,  ///< the axes point toward the middle of the robot
  kO,  ///< the axes form a rhombus
};

/// Makes the wheels of a robot mecanum wheels: sets the direction of their rollers. `angle_rad`: angle between the axes
/// of the rollers and the axle, in (0, pi/2). Throws InputError unless the robot has exactly four wheels, all driven
/// and none steered, a front and a rear one on each side, or if the wheels do not determine the yaw rate.
void add_rollers(RollerPattern pattern, double angle_rad, RobotDescription& robot);

/// Returns whether the robot has mecanum wheels.
bool has_rollers(const RobotDescription& robot);

/// Returns the type of drive. Throws InputError for a robot without driven wheels on both sides.
WheelDriveType wheel_drive_type(const RobotDescription& robot);

/// Left and right wheels or tracks that are not steered.
struct DifferentialGeometry {
  double gauge_m = 0.0;           ///< distance between the center lines of the two sides
  double contact_length_m = 0.0;  ///< distance between the first and the last contact of a side with the ground
  double rolling_radius_m = 0.0;  ///< mean wheel radius, or pitch radius of the sprockets
  double middle_x_m = 0.0;        ///< longitudinal position in body of the middle of these wheels; 0 for tracks and
                                  ///< mecanum wheels
};

/// Returns the geometry of the tracks, or of the wheels that are not steered and, if any of these is driven, driven.
/// Throws InputError for a robot with neither.
DifferentialGeometry differential_geometry(const RobotDescription& robot);

/// Turn of a differential drive.
struct SkidTurn {
  double gauge_ratio = 1.0;  ///< gauge of a differential drive without slip relative to the geometric gauge, for the
                             ///< same wheel speeds and yaw rate
  double turn_center_x_m = 0.0;  ///< longitudinal position in body of the point that moves straight ahead in a turn
};

/// Returns the turn of tracks or wheels: the ratio is 1 for two driven wheels, more for skid steering and mecanum
/// wheels.
///
/// Mecanum wheels turn without slip: the ratio is 1 + (wheelbase / gauge) / tan(angle of the rollers to the axle).
/// Others: Coulomb friction on level ground, with neither a lateral force nor a moment on the robot. The center of mass
/// determines the load of each wheel, and that of tracks is uniform. With equal loads, the ratio of four wheels is
/// 1 + (wheelbase / gauge)^2, and the turn center is in the middle. If one axle carries so much that its wheels drive
/// the turn without slip, the ratio is 1 and the turn center is in that axle. The result depends neither on the
/// friction coefficient nor on the speed.
SkidTurn skid_turn(const RobotDescription& robot);

/// Returns the gauge ratio of skid_turn().
inline double skid_ratio(const RobotDescription& robot) { return skid_turn(robot).gauge_ratio; }

/// Set points of the joints of a wheeled robot, [joint] as in `RobotDescription::joint_names`.
struct WheelCommand {
  std::vector<double> speed_radps;  ///< driven wheels; 0 for steering joints
  std::vector<double> angle_rad;    ///< steering joints; 0 for driven wheels
};

/// Returns the wheel speeds and steering angles of a planar motion: forward speed and yaw rate at the turn center, and
/// for mecanum wheels the lateral speed, positive to the left. Other drives ignore the lateral speed.
///
/// Steered wheels point along their velocity in the plane; the yaw rate is reduced until every steering angle is within
/// the limits of its joint. If the robot stands, the steering angles are those of `last_angle_rad` [joint].
/// `effective_gauge_ratio` multiplies the gauge of a differential drive (`skid_ratio`).
WheelCommand wheel_command(const RobotDescription& robot, double forward_mps, double yaw_rate_radps,
                           double effective_gauge_ratio, const std::vector<double>& last_angle_rad,
                           double lateral_mps = 0.0);

/// Scales wheel speeds [joint] so that none exceeds the limit of its joint; the direction and the curvature of the
/// motion stay.
void limit_wheel_speeds(const RobotDescription& robot, std::vector<double>& speed_radps);

/// Motion of a robot by its mecanum wheels [Muir87].
struct WheelMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< body origin: forward m/s, left m/s, yaw rate rad/s
  /// Part of the wheel speeds that no motion without slip explains, root mean square over the wheels, m/s; with the
  /// sign of its speed of the first wheel.
  double residual_mps = 0.0;
};

/// Returns the motion of mecanum wheels at the speeds [joint], by least squares. The function is linear: angles yield a
/// displacement along constant directions in body. Throws InputError for a robot without mecanum wheels.
WheelMotion mecanum_motion(const RobotDescription& robot, const std::vector<double>& speed_radps);

/// Returns the minimum turning radius of the turn center, m: 0 for a robot that turns in place.
double min_turning_radius_m(const RobotDescription& robot);

}  // namespace patrol
