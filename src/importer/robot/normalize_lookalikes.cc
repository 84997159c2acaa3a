#include "importer/robot/normalize_lookalikes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "importer/robot/axial_shape.h"

namespace patrol::importer {
namespace {

constexpr double kSameRadius = 0.035;                    // relative
constexpr double kMirrorRadius = 0.2, kMirrorPos = 0.2;  // of a wheel across, to its radius

/// Link of the chassis that looks like a wheel. Positions are in the base.
struct Lookalike {
  const SourceLink* link = nullptr;
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Returns the radius of a horizontal cylinder, or of a mesh that is round about the direction of an axle; else 0.
double wheel_radius_m(const Shape& shape, const Pose3& T_base_link, const Eigen::Vector3d& center_m,
                      const Eigen::Vector3d& axle) {
  constexpr double kMaxSine = 0.17;  // 10 degrees
  if (shape.type == ShapeType::kCylinder) {
    const Eigen::Vector3d axis = T_base_link.rotation * (shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ());
    return std::abs(axis.z()) <= kMaxSine ? shape.radius_m : 0.0;
  }
  if (shape.type != ShapeType::kMesh) return 0.0;
  const Pose3 T_base_axis{center_m, Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axle)};
  const AxialShape axial = axial_shape(shape, T_base_axis.inverse() * T_base_link);
  return axial.is_round ? axial.radius_m : 0.0;
}

bool mirrors(const Lookalike& part, const FoundWheel& wheel) {
  const double tolerance_m = kMirrorPos * wheel.radius_m;
  return std::abs(part.radius_m - wheel.radius_m) <= kMirrorRadius * wheel.radius_m &&
         std::abs(wheel.center_m.y()) > wheel.radius_m &&
         std::abs(part.center_m.x() - wheel.center_m.x()) <= tolerance_m &&
         std::abs(part.center_m.y() + wheel.center_m.y()) <= tolerance_m;
}

/// Returns whether another lookalike is across: two of them may be skids of a robot.
bool has_lookalike_across(const Lookalike& part, const std::vector<Lookalike>& all) {
  return std::ranges::any_of(all, [&part](const Lookalike& other) {
    return other.link != part.link && std::abs(other.radius_m - part.radius_m) <= kSameRadius * part.radius_m &&
           std::abs(other.center_m.x() - part.center_m.x()) <= kMirrorPos * part.radius_m &&
           std::abs(other.center_m.y() - part.center_m.y()) > part.radius_m;
  });
}

/// Returns the largest shape of a link that is like a wheel; none if no shape is, or if it is not on the ground.
std::optional<Lookalike> lookalike_of(const RobotLayout& layout, const SourceLink& link) {
  const bool has_collisions = !link.collisions.empty();
  const std::vector<Shape>& shapes = bounding_shapes(link);
  const Pose3 T_base_link = layout.T_base(link.name);
  Lookalike largest{.link = &link};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (has_collisions && layout.support_shapes.contains({link.name, i})) continue;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& point : outline(shapes[i])) box.extend(T_base_link * point);
    const double radius_m = wheel_radius_m(shapes[i], T_base_link, box.center(), layout.found.wheels.front().axis);
    if (radius_m > largest.radius_m) largest = {.link = &link, .center_m = box.center(), .radius_m = radius_m};
  }
  const bool is_found = largest.radius_m > 0.0 && layout.is_near_ground(largest.center_m.z() - largest.radius_m);
  return is_found ? std::optional(largest) : std::nullopt;
}

/// Returns the joint that should turn a link about its axle: the one above it, or the movable one above a fixed one.
const SourceJoint* joint_of(const SourceRobot& source, const Lookalike& part) {
  const SourceJoint* joint = source.parent_joint(part.link->name);
  while (joint != nullptr && joint->type == JointType::kFixed) {
    const SourceJoint* above = source.parent_joint(joint->parent);
    if (above == nullptr || above->type == JointType::kFixed) break;
    joint = above;
  }
  return joint;
}

/// Refuses a lookalike if a wheel is like it. `is_one_of_pair`: another lookalike is across, both on fixed joints.
void refuse_if_like_wheel(const RobotLayout& layout, const Lookalike& part, const SourceJoint& joint,
                          bool is_one_of_pair) {
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster || wheel.is_ball) continue;
    if ((part.center_m - wheel.center_m).norm() < 0.5 * wheel.radius_m) return;  // a part of this wheel
    const bool is_same = std::abs(part.radius_m - wheel.radius_m) <= kSameRadius * wheel.radius_m;
    const bool is_across = mirrors(part, wheel);
    if (!is_across && (!is_same || is_one_of_pair)) continue;
    layout.source.fail(joint.line, part.link->name,
                       fmt::format("touches the ground like wheel {}, {}, but {}: a wheel must turn about its axle; "
                                   "--caster {} if it slides",
                                   wheel.joint->child, is_across ? "which it is across from" : "whose radius it has",
                                   joint.type == JointType::kFixed
                                       ? fmt::format("joint {} is fixed", joint.name)
                                       : fmt::format("joint {} does not turn it about its axle", joint.name),
                                   part.link->name));
  }
}

}  // namespace

void refuse_unturned_wheels(const RobotLayout& layout, const std::set<std::string>& sliding) {
  std::vector<Lookalike> lookalikes;
  for (const std::string& name : layout.chassis) {
    if (name == layout.base || sliding.contains(name)) continue;
    if (const auto part = lookalike_of(layout, layout.source.link(name))) lookalikes.push_back(*part);
  }
  for (const Lookalike& part : lookalikes) {
    const SourceJoint* joint = joint_of(layout.source, part);
    if (joint == nullptr) continue;
    const bool is_one_of_pair = joint->type == JointType::kFixed && has_lookalike_across(part, lookalikes);
    refuse_if_like_wheel(layout, part, *joint, is_one_of_pair);
  }
}

}  // namespace patrol::importer
