#include "importer/leg_finder.h"

#include <algorithm>

#include "core/error.h"
#include "importer/wheel_finder.h"

namespace patrol::importer {
namespace {

bool turns(const SourceJoint& joint) {
  return joint.type == JointType::kRevolute || joint.type == JointType::kContinuous;
}

/// Returns the movable joints from the root to a joint, this one included. A floating joint above the base is no joint
/// of the robot.
std::vector<const SourceJoint*> chain_to(const SourceRobot& robot, const SourceJoint& last) {
  std::vector<const SourceJoint*> chain;
  for (const SourceJoint* at = &last; at != nullptr; at = robot.parent_joint(at->parent)) {
    if (at->type != JointType::kFixed && at->type != JointType::kFloating) chain.insert(chain.begin(), at);
  }
  return chain;
}

bool has_movable_joint_below(const SourceRobot& robot, const std::string& link) {
  const std::vector<const SourceJoint*> children = robot.child_joints(link);
  return std::any_of(children.begin(), children.end(), [&](const SourceJoint* child) {
    return child->type != JointType::kFixed || has_movable_joint_below(robot, child->child);
  });
}

/// Returns whether the last joints turn wheels.
bool end_in_wheels(const SourceRobot& robot, const std::vector<FoundLeg>& legs) {
  const bool are_endless =
      std::all_of(legs.begin(), legs.end(), [](const FoundLeg& leg) { return leg.joints.back()->is_endless(); });
  if (!are_endless) return false;
  try {
    const FoundWheels found = find_wheels(robot);
    return std::any_of(found.wheels.begin(), found.wheels.end(),
                       [&](const FoundWheel& wheel) { return wheel.joint == legs.front().joints.back(); });
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::vector<FoundLeg> find_legs(const SourceRobot& robot) {
  std::vector<FoundLeg> legs;
  for (const SourceJoint& joint : robot.joints) {
    if (!turns(joint) || has_movable_joint_below(robot, joint.child)) continue;
    const std::vector<const SourceJoint*> chain = chain_to(robot, joint);
    if (chain.size() != 3 || !turns(*chain[0]) || !turns(*chain[1])) continue;
    legs.push_back({{chain[0], chain[1], chain[2]}});
  }
  if (legs.size() != 4 || end_in_wheels(robot, legs)) return {};
  return legs;
}

}  // namespace patrol::importer
