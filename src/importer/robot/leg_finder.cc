#include "importer/robot/leg_finder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/error.h"
#include "importer/robot/wheel_finder.h"

namespace patrol::importer {
namespace {

bool turns(const SourceJoint& joint) {
  return joint.type == JointType::kRevolute || joint.type == JointType::kContinuous;
}

/// Returns the movable joints from the root to a joint, this one included. Joints that move the whole robot are no
/// joints of a leg.
std::vector<const SourceJoint*> chain_to(const SourceRobot& robot, const SourceJoint& last) {
  std::vector<const SourceJoint*> path;  // from the joint up
  for (const SourceJoint* at = &last; at != nullptr; at = robot.parent_joint(at->parent)) {
    if (at->type != JointType::kFixed) path.push_back(at);
  }
  std::vector<const SourceJoint*> chain;
  std::ranges::reverse(path);
  for (const SourceJoint* joint : path) {
    // Below a joint that does not move the whole robot, only floating joints can.
    const bool can_move_all = chain.empty() || joint->type == JointType::kFloating;
    if (!can_move_all || !robot.moves_whole_robot(*joint)) chain.push_back(joint);
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

/// Lengths of a chain of three joints and height of its end, with all joints at zero.
struct ChainSize {
  std::array<double, 3> lengths_m = {};  ///< distances between joints, and from the last one to the end of its shapes
  double lowest_m = 0.0;                 ///< in the root
};

ChainSize size_of(const SourceRobot& robot, const std::map<std::string, Pose3>& T_root_link, const FoundLeg& leg) {
  std::array<Eigen::Vector3d, 3> p_m;
  for (std::size_t i = 0; i < 3; ++i) p_m[i] = T_root_link.at(leg.joints[i]->child).position;
  ChainSize size{.lengths_m = {(p_m[1] - p_m[0]).norm(), (p_m[2] - p_m[1]).norm(), 0.0}, .lowest_m = p_m[2].z()};
  for (const SourceLink* link : rigid_group(robot, leg.joints[2]->child, {})) {
    for (const Shape& shape : link->collisions.empty() ? link->visuals : link->collisions) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        const Eigen::Vector3d end_m = T_root_link.at(link->name) * point;
        size.lengths_m[2] = std::max(size.lengths_m[2], (end_m - p_m[2]).norm());
        size.lowest_m = std::min(size.lowest_m, end_m.z());
      }
    }
  }
  return size;
}

bool are_alike(const ChainSize& a, const ChainSize& b) {
  constexpr double kAlike = 0.25, kAlike_m = 0.01;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(a.lengths_m[i] - b.lengths_m[i]) > kAlike * std::max(a.lengths_m[i], b.lengths_m[i]) + kAlike_m)
      return false;
  }
  return true;
}

/// Keeps the four chains that end lowest if they are alike and no other one is like them. The others are arms, gimbals
/// and the like.
void keep_four_lowest(const SourceRobot& robot, std::vector<FoundLeg>& legs) {
  const std::map<std::string, Pose3> T_root_link = link_poses(robot);
  std::vector<std::pair<ChainSize, FoundLeg>> chains;
  for (const FoundLeg& leg : legs) chains.emplace_back(size_of(robot, T_root_link, leg), leg);
  std::stable_sort(chains.begin(), chains.end(),
                   [](const auto& a, const auto& b) { return a.first.lowest_m < b.first.lowest_m; });
  for (std::size_t i = 1; i < chains.size(); ++i) {
    if (are_alike(chains[0].first, chains[i].first) != (i < 4)) return;
  }
  std::erase_if(legs, [&chains](const FoundLeg& leg) {
    return std::none_of(chains.begin(), chains.begin() + 4,
                        [&leg](const auto& chain) { return chain.second.joints == leg.joints; });
  });
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
  if (legs.size() > 4) keep_four_lowest(robot, legs);
  if (legs.size() != 4 || end_in_wheels(robot, legs)) return {};
  return legs;
}

}  // namespace patrol::importer
