#include "importer/robot/source_robot.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <set>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/xacro.h"
#include "io/files/one_line.h"

namespace patrol::importer {

bool SourceJoint::is_endless() const {
  constexpr double kTwoTurns_rad = 4.0 * std::numbers::pi - 1e-3;
  return type == JointType::kContinuous || (type == JointType::kRevolute && upper - lower >= kTwoTurns_rad);
}

std::optional<std::pair<double, double>> SourceJoint::steering_limits() const {
  constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi + 1e-3;
  if (!is_endless()) return std::pair{lower, upper};
  const bool is_steering =
      type == JointType::kContinuous && lower < 0.0 && upper > 0.0 && std::max(-lower, upper) <= kQuarterTurn_rad;
  return is_steering ? std::optional(std::pair{lower, upper}) : std::nullopt;
}

/// Adds new links and joints to the index. Of equal names, the first one counts.
void SourceRobot::extend_index() const {
  for (; index.num_links < links.size(); ++index.num_links)
    index.link.try_emplace(links[index.num_links].name, index.num_links);
  for (; index.num_joints < joints.size(); ++index.num_joints) {
    const SourceJoint& joint = joints[index.num_joints];
    index.joint.try_emplace(joint.name, index.num_joints);
    index.joint_above.try_emplace(joint.child, index.num_joints);
    index.joints_below[joint.parent].push_back(index.num_joints);
  }
}

const SourceLink* SourceRobot::find_link(const std::string& link_name) const {
  extend_index();
  const auto found = index.link.find(link_name);
  return found == index.link.end() ? nullptr : &links[found->second];
}

const SourceLink& SourceRobot::link(const std::string& link_name) const {
  const SourceLink* found = find_link(link_name);
  if (found == nullptr) throw InputError(fmt::format("{}: unknown link: {}", file, link_name));
  return *found;
}

const SourceJoint* SourceRobot::parent_joint(const std::string& link_name) const {
  extend_index();
  const auto found = index.joint_above.find(link_name);
  return found == index.joint_above.end() ? nullptr : &joints[found->second];
}

const SourceJoint* SourceRobot::find_joint(const std::string& joint_name) const {
  extend_index();
  const auto found = index.joint.find(joint_name);
  return found == index.joint.end() ? nullptr : &joints[found->second];
}

std::vector<const SourceJoint*> SourceRobot::child_joints(const std::string& link_name) const {
  extend_index();
  std::vector<const SourceJoint*> children;
  const auto found = index.joints_below.find(link_name);
  if (found == index.joints_below.end()) return children;
  for (const std::size_t i : found->second) children.push_back(&joints[i]);
  return children;
}

const SourceLink& SourceRobot::root() const {
  for (const SourceLink& link : links) {
    if (parent_joint(link.name) == nullptr) return link;
  }
  throw InputError(file + ": the joints form a cycle");
}

bool SourceRobot::moves_whole_robot(const SourceJoint& joint) const {
  constexpr double kNegligible = 0.01;  // to the mass of the robot
  const bool is_floating = joint.type == JointType::kFloating;
  const auto has_own_shapes = [is_floating](const SourceLink& each) {
    return is_floating ? !each.collisions.empty() : each.has_shapes();
  };
  for (const SourceJoint* at = &joint; at != nullptr; at = parent_joint(at->parent)) {
    if (has_own_shapes(link(at->parent))) return false;
  }
  std::set<std::string> moved = {joint.child};
  std::vector<std::string> open = {joint.child};
  while (!open.empty()) {
    const std::string at = open.back();
    open.pop_back();
    for (const SourceJoint* child : child_joints(at)) {
      if (moved.insert(child->child).second) open.push_back(child->child);
    }
  }
  double mass_kg = 0.0, other_kg = 0.0;
  for (const SourceLink& each : links) {
    const double link_kg = each.inertial ? each.inertial->mass_kg : 0.0;
    mass_kg += link_kg;
    if (moved.contains(each.name)) continue;
    if (has_own_shapes(each)) return false;
    other_kg += link_kg;
  }
  return other_kg <= kNegligible * mass_kg;
}

std::string SourceRobot::location(int line) const { return location_in(file, positions, line); }

std::string SourceRobot::short_location(int line) const {
  if (positions.empty()) return fmt::format("line {}", line);
  return std::filesystem::path(location(line)).filename().string();
}

void SourceRobot::fail(int line, const std::string& element, const std::string& what) const {
  throw InputError(fmt::format("{}: {}: {}", location(line), io::on_one_line(element), what));
}

}  // namespace patrol::importer
