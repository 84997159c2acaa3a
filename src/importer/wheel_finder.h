#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/source_robot.h"

namespace patrol::importer {

/// Joint that turns the carrier of a wheel about the vertical.
enum class CarrierType { kNone, kSteering, kCaster };

/// Wheel of a description, found by its shape and its contact with the ground. Positions and directions are in the root
/// with all joints at zero.
struct FoundWheel {
  const SourceJoint* joint = nullptr;    ///< about the axle
  const SourceJoint* carrier = nullptr;  ///< nearest vertical joint above, if `carrier_type` says so
  CarrierType carrier_type = CarrierType::kNone;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< horizontal unit vector along the joint's axis
  double radius_m = 0.0;
  double width_m = 0.0;
  bool is_ball = false;  ///< all its shapes are spheres: the width is assumed

  double bottom_m() const { return center_m.z() - radius_m; }
};

/// Wheels of a description and the height of the ground below them.
struct FoundWheels {
  std::vector<FoundWheel> wheels;
  double ground_m = 0.0;  ///< in the root
  std::vector<Assumption> assumptions;
};

/// Returns the poses of all links in the root with all joints at zero.
std::map<std::string, Pose3> link_poses(const SourceRobot& robot);

/// Returns a link and the links below it that follow it when all joints but `kept` are fixed.
std::vector<const SourceLink*> rigid_group(const SourceRobot& robot, const std::string& link,
                                           const std::set<const SourceJoint*>& kept);

/// Finds the wheels: links on endless joints about a horizontal axis, round about it within 3.5 %, whose lowest point
/// is within 2 % of the radius plus 5 mm of the common ground plane. Throws InputError if there are none, if they are
/// not on one plane or if a wheel has rollers.
FoundWheels find_wheels(const SourceRobot& robot);

}  // namespace patrol::importer
