#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "importer/robot/leg_finder.h"
#include "importer/robot/normalized_robot.h"
#include "importer/robot/wheel_finder.h"

namespace patrol::importer {

/// Part without a motor that slides on the ground: center in the base and radius.
struct Support {
  std::string name;
  Eigen::Vector3d center_m;
  double radius_m;
  std::string link;  ///< link of the file from which mass is taken; empty: base
};

/// Mass of the file and box around all shapes, in the root.
struct SourceExtent {
  double mass_kg = 0.0;
  Eigen::AlignedBox3d box = {};

  double size_m() const { return box.isEmpty() ? 0.0 : box.diagonal().norm(); }
};

/// Decisions about a description that are made before the first link of the result: wheels or legs, motors, the chassis
/// and the frame of the base. Complete when the result has its first link.
struct RobotLayout {
  const SourceRobot& source;
  std::map<std::string, Pose3> T_root_link;  ///< poses of all links of the file
  SourceExtent extent = {};
  DriveType drive = DriveType::kDifferential;
  std::vector<FoundLeg> legs = {};            ///< four; none for a robot on wheels
  FoundWheels found = {};                     ///< in the base after the choice of the frame
  std::set<const SourceJoint*> kept = {};     ///< movable joints of the result
  std::set<const SourceJoint*> driven = {};   ///< wheel joints with motors
  std::set<const SourceJoint*> casters = {};  ///< wheel joints that are replaced by supports
  std::set<std::string> chassis = {};         ///< links of the base's rigid group
  std::string base = {};                      ///< link of the file that becomes the base
  Pose3 T_root_base = {};
  double ground_m = 0.0;  ///< height of the ground in the base
  std::set<std::pair<std::string, std::size_t>> support_shapes =
      {};  ///< link and index of collisions made into supports
  std::vector<Support> supports = {};

  Pose3 T_base(const std::string& link) const { return T_root_base.inverse() * T_root_link.at(link); }
  /// Returns the links of the file that move with the child of a joint.
  std::vector<const SourceLink*> moving_group(const SourceJoint& joint) const;
  /// Returns whether the lowest point of a part touches the ground; `bottom_m` is in the base.
  bool is_near_ground(double bottom_m) const;
};

inline Pose3 translation(const Eigen::Vector3d& position) { return {.position = position}; }

/// Returns the shapes that bound a link: its collisions, without any its visuals.
inline const std::vector<Shape>& bounding_shapes(const SourceLink& link) {
  return link.collisions.empty() ? link.visuals : link.collisions;
}

/// Returns the angle of an axle relative to y of the base, in (-pi/2, pi/2].
double axle_angle_rad(const Eigen::Vector3d& axis);

/// Returns the extent of a description.
SourceExtent measure_extent(const RobotLayout& layout);

/// Refuses a center of mass that is farther from the shapes than the robot is large.
void check_centers(const RobotLayout& layout);

}  // namespace patrol::importer
