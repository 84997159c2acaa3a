#include "importer/robot/fixed_wheels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "importer/robot/leg_finder.h"
#include "importer/robot/wheel_finder.h"

namespace patrol::importer {
namespace {

constexpr double kOffCenter = 0.035;               // to the radius
constexpr double kMaxSine = 0.05;                  // 2.9 degrees
constexpr double kMaxLength = 2.5;                 // to the radius
constexpr double kTouch = 0.02, kTouch_m = 0.005;  // to the radius, and in addition

/// Horizontal cylinder on a fixed joint. Positions and directions are in the root.
struct FixedWheel {
  SourceJoint* joint = nullptr;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< unit vector along the cylinder
  Eigen::Vector3d axis_in_link = Eigen::Vector3d::UnitY();
  double radius_m = 0.0;

  double bottom_m() const { return center_m.z() - radius_m; }
};

/// Returns the largest horizontal cylinder of a link as a wheel; its radius is 0 if there is none.
FixedWheel horizontal_cylinder(const SourceLink& link, const Pose3& T_root_link, SourceJoint& joint) {
  FixedWheel wheel;
  for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
    const Eigen::Vector3d axis = shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d& center = shape.T_link_shape.position;
    const Eigen::Vector3d axis_in_root = T_root_link.rotation * axis;
    const bool is_wheel = shape.type == ShapeType::kCylinder && shape.length_m <= kMaxLength * shape.radius_m &&
                          (center - center.dot(axis) * axis).norm() <= kOffCenter * shape.radius_m &&
                          std::abs(axis_in_root.z()) <= kMaxSine;
    if (!is_wheel || shape.radius_m <= wheel.radius_m) continue;
    wheel = {.joint = &joint,
             .center_m = T_root_link * center,
             .axis = axis_in_root,
             .axis_in_link = axis,
             .radius_m = shape.radius_m};
  }
  return wheel;
}

double lowest_point_m(const SourceRobot& robot, const std::map<std::string, Pose3>& T_root_link) {
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const SourceLink& link : robot.links) {
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape))
        lowest_m = std::min(lowest_m, (T_root_link.at(link.name) * point).z());
    }
  }
  return lowest_m;
}

/// Returns whether a joint that turns about a horizontal axis is above a joint: the wheel of a leg, or a part of one
/// that turns.
bool is_below_turning_joint(const SourceRobot& robot, const SourceJoint& joint,
                            const std::map<std::string, Pose3>& T_root_link) {
  for (const SourceJoint* at = robot.parent_joint(joint.parent); at != nullptr; at = robot.parent_joint(at->parent)) {
    const Eigen::Vector3d axis = T_root_link.at(at->child).rotation * at->axis;
    const bool turns = at->type == JointType::kRevolute || at->type == JointType::kContinuous;
    if (turns && std::abs(axis.z()) <= kMaxSine) return true;
  }
  return false;
}

/// Returns whether another wheel has a parallel axis and is across from this one.
bool has_partner(const FixedWheel& wheel, const std::vector<FixedWheel>& wheels) {
  return std::any_of(wheels.begin(), wheels.end(), [&wheel](const FixedWheel& other) {
    const bool is_parallel = std::abs(wheel.axis.dot(other.axis)) > 1.0 - kMaxSine * kMaxSine;
    return is_parallel && std::abs((other.center_m - wheel.center_m).dot(wheel.axis)) > wheel.radius_m;
  });
}

}  // namespace

void release_fixed_wheels(SourceRobot& robot) {
  if (!find_legs(robot).empty() || has_wheels(robot)) return;
  const std::map<std::string, Pose3> T_root_link = link_poses(robot);
  const double ground_m = lowest_point_m(robot, T_root_link);
  std::vector<FixedWheel> wheels;
  for (SourceJoint& joint : robot.joints) {
    if (joint.type != JointType::kFixed) continue;
    const FixedWheel wheel = horizontal_cylinder(robot.link(joint.child), T_root_link.at(joint.child), joint);
    const bool touches = wheel.radius_m > 0.0 && wheel.bottom_m() - ground_m <= kTouch * wheel.radius_m + kTouch_m;
    if (touches && !is_below_turning_joint(robot, joint, T_root_link)) wheels.push_back(wheel);
  }
  for (const FixedWheel& wheel : wheels) {
    if (!has_partner(wheel, wheels)) continue;
    wheel.joint->type = JointType::kContinuous;
    wheel.joint->axis = wheel.axis_in_link;
    robot.assumptions.push_back(
        {.subject = wheel.joint->name,
         .text = "turns, although the file fixes it: the file has no wheels that turn, and its link is a horizontal "
                 "cylinder that touches the ground, with another one across from it",
         .override_with = "type of the joint"});
  }
}

}  // namespace patrol::importer
