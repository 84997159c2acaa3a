#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Joint that turns the carrier of a wheel about the vertical.
enum class CarrierType { kNone, kSteering, kCaster };

/// Wheel of a description, found by its shape and its contact with the ground. Positions and directions are in the root
/// with all joints at zero.
struct FoundWheel {
  const SourceJoint* joint = nullptr;    ///< joint about the axle
  const SourceJoint* carrier = nullptr;  ///< nearest vertical joint above, if `carrier_type` says so
  CarrierType carrier_type = CarrierType::kNone;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< horizontal unit vector along the joint's axis
  double radius_m = 0.0;
  double width_m = 0.0;
  bool is_ball = false;  ///< all its shapes are spheres: the width is assumed
  int num_rollers = 0;   ///< links on passive endless joints around the wheel
  /// Direction of the axis of the lowest roller, from forward to the left, with the axle to the left, in (-pi/2, pi/2);
  /// only with rollers.
  double roller_axis_rad = 0.0;

  double bottom_m() const { return center_m.z() - radius_m; }
};

/// Link on an endless joint that is no wheel.
struct RejectedWheel {
  const SourceJoint* joint = nullptr;
  std::string reason;  ///< reason for the rejection
};

/// Wheels of a description and the height of the ground below them.
struct FoundWheels {
  std::vector<FoundWheel> wheels;
  std::set<const SourceJoint*> roller_joints;
  std::vector<RejectedWheel> rejected;
  double ground_m = 0.0;  ///< in the root
  std::vector<Assumption> assumptions;
};

/// Returns the poses of all links in the root with all joints at zero.
std::map<std::string, Pose3> link_poses(const SourceRobot& robot);

/// Returns a link and the links below it that follow it when all joints but `kept` are fixed.
std::vector<const SourceLink*> rigid_group(const SourceRobot& robot, const std::string& link,
                                           const std::set<const SourceJoint*>& kept);

/// Returns whether a link on an endless joint about a horizontal axis is round about it, at any height.
bool has_wheels(const SourceRobot& robot);

/// Finds the wheels: links on endless joints about a horizontal axis, round about it within 3.5 %, whose lowest point
/// is within 2 % of the radius plus 5 mm of the common ground plane. The links on at least four passive endless joints
/// below the joint of a wheel are its rollers; they determine its radius. Throws InputError if there are no wheels, if
/// they are not on one plane, if this plane is upright, or if the rollers of a wheel are not those of a mecanum wheel.
FoundWheels find_wheels(const SourceRobot& robot);

}  // namespace patrol::importer
