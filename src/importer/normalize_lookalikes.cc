#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "importer/axial_shape.h"
#include "importer/normalizer.h"

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

}  // namespace

/// Refuses a link of the chassis that looks like a wheel, but that no joint turns about its axle: often one wheel of
/// several with a wrong axis or type of its joint. It is a cylinder or a round mesh on the ground. It is across from a
/// wheel, or it has the radius of a wheel and is not one of a pair on fixed joints.
void Normalizer::refuse_unturned_wheels() const {
  std::vector<Lookalike> lookalikes;
  for (const std::string& name : chassis_) {
    if (name == base_ || options_.casters.contains(name)) continue;
    const SourceLink& link = source_.link(name);
    const bool has_collisions = !link.collisions.empty();
    const std::vector<Shape>& shapes = has_collisions ? link.collisions : link.visuals;
    Lookalike largest{.link = &link};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (has_collisions && support_shapes_.contains({name, i})) continue;
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& point : outline(shapes[i])) box.extend(T_base(name) * point);
      const double radius_m = wheel_radius_m(shapes[i], T_base(name), box.center(), found_.wheels.front().axis);
      if (radius_m > largest.radius_m) largest = {.link = &link, .center_m = box.center(), .radius_m = radius_m};
    }
    if (largest.radius_m > 0.0 && is_near_ground(largest.center_m.z() - largest.radius_m))
      lookalikes.push_back(largest);
  }
  for (const Lookalike& part : lookalikes) {
    const SourceJoint* joint = source_.parent_joint(part.link->name);
    while (joint != nullptr && joint->type == JointType::kFixed && source_.parent_joint(joint->parent) != nullptr &&
           source_.parent_joint(joint->parent)->type != JointType::kFixed)
      joint = source_.parent_joint(joint->parent);
    if (joint == nullptr) continue;
    const bool is_one_of_pair = joint->type == JointType::kFixed && has_lookalike_across(part, lookalikes);
    for (const FoundWheel& wheel : found_.wheels) {
      if (wheel.carrier_type == CarrierType::kCaster || wheel.is_ball) continue;
      if ((part.center_m - wheel.center_m).norm() < 0.5 * wheel.radius_m) break;  // a part of this wheel
      const bool is_same = std::abs(part.radius_m - wheel.radius_m) <= kSameRadius * wheel.radius_m;
      const bool is_across = mirrors(part, wheel);
      if (!is_across && (!is_same || is_one_of_pair)) continue;
      source_.fail(joint->line, part.link->name,
                   fmt::format("touches the ground like wheel {}, {}, but {}: a wheel must turn about its axle; "
                               "--caster {} if it slides",
                               wheel.joint->child, is_across ? "which it is across from" : "whose radius it has",
                               joint->type == JointType::kFixed
                                   ? fmt::format("joint {} is fixed", joint->name)
                                   : fmt::format("joint {} does not turn it about its axle", joint->name),
                               part.link->name));
    }
  }
}

}  // namespace patrol::importer
