#include "importer/robot/normalize_chassis.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importer/robot/normalize_inertias.h"

namespace patrol::importer {
namespace {

/// What the links of the chassis have in the file.
struct ChassisContent {
  bool has_collision = false, has_visual = false;
  double mass_kg = 0.0;
};

ChassisContent content_of_chassis(const RobotLayout& layout) {
  ChassisContent content;
  for (const std::string& name : layout.chassis) {
    const SourceLink& link = layout.source.link(name);
    content.has_collision = content.has_collision || !link.collisions.empty();
    content.has_visual = content.has_visual || !link.visuals.empty();
    if (link.inertial) content.mass_kg += link.inertial->mass_kg;
  }
  return content;
}

/// Returns the links of the chassis, the base first, without massless ones without shapes above the base.
std::vector<const SourceLink*> links_of_chassis(const RobotLayout& layout) {
  const SourceRobot& source = layout.source;
  std::set<std::string> above;
  for (const SourceJoint* joint = source.parent_joint(layout.base); joint != nullptr;
       joint = source.parent_joint(joint->parent)) {
    if (!source.link(joint->parent).has_shapes() && !source.link(joint->parent).inertial) above.insert(joint->parent);
  }
  std::vector<const SourceLink*> links = {&source.link(layout.base)};
  for (const SourceLink& link : source.links) {
    if (layout.chassis.contains(link.name) && link.name != layout.base && !above.contains(link.name))
      links.push_back(&link);
  }
  return links;
}

/// Returns the inertia of a link of a chassis without mass: that of its shapes.
Inertial assumed_inertial(const SourceLink& link, const Pose3& T_target_link, std::vector<Assumption>& rows) {
  std::vector<Shape> shapes = bounding_shapes(link);
  for (Shape& shape : shapes) shape.T_link_shape = T_target_link * shape.T_link_shape;
  const Inertial inertial = solid_inertial(shapes, 0.0);
  rows.push_back({link.name,
                  fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shapes",
                              inertial.mass_kg, kDensity_kgpm3),
                  "<inertial> of the link"});
  return inertial;
}

/// Adds a link of the chassis with its shapes and its mass.
void add_chassis_link(const RobotLayout& layout, const SourceLink& link, const ChassisContent& content,
                      LinkBuilder& links, NormalizedRobot& robot) {
  NormalizedLink target{.name = links.link_name(link.name)};
  const Pose3 T_base_link = layout.T_base(link.name);
  Pose3 T_target_link;
  if (link.name == layout.base) {
    T_target_link = T_base_link;
  } else {
    const SourceJoint* joint = layout.source.parent_joint(link.name);
    const std::string name = links.joint_name(joint != nullptr ? joint->name : link.name + "_joint");
    target.joint = NormalizedJoint{.name = name, .parent = "base_link", .T_parent_link = T_base_link};
  }
  links.add_visuals(link, T_target_link, target);
  links.add_collisions(link, T_target_link, !content.has_collision, target);
  if (const auto inertial = checked_inertial(layout, link, robot.assumptions)) {
    target.inertial = combine({{T_target_link, *inertial}});
  } else if (content.mass_kg <= 0.0 && link.has_shapes()) {
    target.inertial = assumed_inertial(link, T_target_link, robot.assumptions);
  }
  robot.links.push_back(std::move(target));
}

/// Reports links with shapes and without mass on a chassis that has masses.
void report_massless(const ChassisContent& content, const std::vector<const SourceLink*>& links,
                     std::vector<Assumption>& rows) {
  if (content.mass_kg <= 0.0) return;
  std::vector<std::string> massless;
  for (const SourceLink* link : links) {
    if (link->has_shapes() && !link->inertial) massless.push_back(link->name);
  }
  if (massless.empty()) return;
  rows.push_back({list_of(massless),
                  std::string(massless.size() == 1 ? "has" : "have") +
                      " no <inertial>: massless, since other links of the chassis have masses",
                  "<inertial> of the links"});
}

/// Gives base_link a mass. A free body needs a mass of its own: the heaviest fixed link gives it, unless the base has
/// at least a hundredth of the mass of that link.
void give_base_mass(const RobotLayout& layout, NormalizedRobot& robot) {
  constexpr double kMinMass = 0.01;  // to the heaviest link
  NormalizedLink* heaviest = nullptr;
  for (NormalizedLink& link : robot.links) {
    if (link.inertial && (heaviest == nullptr || link.inertial->mass_kg > heaviest->inertial->mass_kg))
      heaviest = &link;
  }
  if (heaviest == nullptr)
    layout.source.fail(layout.source.link(layout.base).line, layout.base, "the chassis has neither mass nor shapes");
  NormalizedLink& base = robot.links.front();
  if (base.inertial && base.inertial->mass_kg >= kMinMass * heaviest->inertial->mass_kg) return;
  std::vector<std::pair<Pose3, Inertial>> parts = {{heaviest->joint->T_parent_link, *heaviest->inertial}};
  if (base.inertial) parts.push_back({{}, *base.inertial});
  base.inertial = combine(parts);
  heaviest->inertial.reset();
}

}  // namespace

void add_chassis(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot) {
  const ChassisContent content = content_of_chassis(layout);
  if (!content.has_collision) {
    robot.assumptions.push_back(
        {"chassis",
         content.has_visual ? "has no <collision>: contact and footprint are those of the visuals"
                            : "has neither <collision> nor <visual>: it touches nothing, and the footprint is that of "
                              "the wheels or legs",
         "<collision> of the links"});
  }
  const std::vector<const SourceLink*> chassis = links_of_chassis(layout);
  for (const SourceLink* link : chassis) add_chassis_link(layout, *link, content, links, robot);
  report_massless(content, chassis, robot.assumptions);
  give_base_mass(layout, robot);
}

double total_mass_kg(const NormalizedRobot& robot) {
  double mass_kg = 0.0;
  for (const NormalizedLink& link : robot.links) {
    if (link.inertial) mass_kg += link.inertial->mass_kg;
  }
  return mass_kg;
}

}  // namespace patrol::importer
