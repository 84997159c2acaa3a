#include "importer/robot/normalize_casters.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "importer/robot/normalize_chassis.h"
#include "importer/robot/normalize_supports.h"

namespace patrol::importer {
namespace {

/// Part of a caster: its carrier or its wheel.
struct CasterPart {
  double radius_m = 0.0;  ///< radius of the wheel
  bool rolls = false;
};

constexpr double kInertia = 2.0;  // to mass times radius squared

/// Takes mass from the chassis and returns it: at most a fifth of the mass of base_link.
double take_from_base(double wanted_kg, NormalizedRobot& robot) {
  Inertial& inertial = *robot.links.front().inertial;
  const double taken_kg = std::min(wanted_kg, 0.2 * inertial.mass_kg);
  inertial.inertia *= 1.0 - taken_kg / inertial.mass_kg;
  inertial.mass_kg -= taken_kg;
  return taken_kg;
}

/// Returns the parts of the casters by their links in the result.
std::map<std::string, CasterPart> parts_of_casters(const RobotLayout& layout, LinkBuilder& links) {
  std::map<std::string, CasterPart> parts;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type != CarrierType::kCaster) continue;
    for (const SourceJoint* joint : {wheel.carrier, wheel.joint})
      parts[links.link_name(joint->child)] = {wheel.radius_m, joint == wheel.joint};
  }
  return parts;
}

/// Raises a small moment of inertia of a part of a caster about the swivel axis or the axle.
void raise_inertia(const CasterPart& part, double wanted_kg, NormalizedLink& link, std::vector<Assumption>& rows) {
  Inertial& inertial = *link.inertial;
  const auto moment_about = [&inertial](const Eigen::Vector3d& axis) {
    const Eigen::Vector3d in_inertia = inertial.T_link_inertia.rotation.conjugate() * axis;
    return in_inertia.dot(inertial.inertia * in_inertia);
  };
  const double about_swivel = moment_about(Eigen::Vector3d::UnitZ()),
               about_axle = moment_about(Eigen::Vector3d::UnitY());
  const double before = part.rolls ? std::min(about_swivel, about_axle) : about_swivel;
  const double missing = kInertia * wanted_kg * part.radius_m * part.radius_m - before;
  if (missing <= 0.0) return;
  inertial.inertia += missing * Eigen::Matrix3d::Identity();
  rows.push_back(
      {link.name,
       fmt::format("its moment of inertia about {} of {:.3g} kg m2 is raised to {:.3g} kg m2: the contact of "
                   "casters with less inertia is unstable in the simulation",
                   part.rolls ? "the swivel axis or the axle" : "the swivel axis", before, before + missing),
       "<inertia> of the link"});
}

/// Gives a light part of a caster mass of the chassis.
void raise_mass(const CasterPart& part, double wanted_kg, NormalizedLink& link, NormalizedRobot& robot) {
  Inertial& inertial = *link.inertial;
  const double before_kg = inertial.mass_kg;
  inertial.mass_kg += take_from_base(wanted_kg - before_kg, robot);
  const double moment = kInertia * inertial.mass_kg * part.radius_m * part.radius_m;
  inertial.inertia = moment * Eigen::Matrix3d::Identity();
  robot.assumptions.push_back(
      {link.name,
       fmt::format(
           "its mass of {:.3g} kg is raised to {:.3g} kg, taken from the chassis, and its moments of inertia to "
           "{:.3g} kg m2: the contact of lighter casters is unstable in the simulation",
           before_kg, inertial.mass_kg, moment),
       "<mass> of the link"});
}

void strengthen_casters(const RobotLayout& layout, double robot_mass_kg, LinkBuilder& links, NormalizedRobot& robot) {
  const std::map<std::string, CasterPart> parts = parts_of_casters(layout, links);
  constexpr double kLight = 0.3;  // to the mass that a part gets
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(parts.size());
  for (NormalizedLink& link : robot.links) {
    const auto part = parts.find(link.name);
    if (part == parts.end()) continue;
    if (link.inertial->mass_kg >= kLight * wanted_kg) raise_inertia(part->second, wanted_kg, link, robot.assumptions);
    else raise_mass(part->second, wanted_kg, link, robot);
  }
}

/// Adds a ball that rolls about y in a carrier that swivels about z, with half the radius of trail.
void add_support(const RobotLayout& layout, const Support& support, double robot_mass_kg, LinkBuilder& links,
                 NormalizedRobot& robot) {
  // Lighter balls make the contact of the simulation unstable.
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(layout.supports.size());
  double mass_kg = 0.0;
  if (!support.link.empty()) {  // the mass of a light part goes to the ball
    for (NormalizedLink& link : robot.links) {
      if (link.name != links.link_name(support.link) || !link.inertial || link.inertial->mass_kg > 1.5 * wanted_kg)
        continue;
      mass_kg = link.inertial->mass_kg;
      link.inertial.reset();
    }
  }
  if (mass_kg < wanted_kg) mass_kg += take_from_base(wanted_kg - mass_kg, robot);
  const double half_kg = 0.5 * mass_kg, trail_m = 0.5 * support.radius_m;
  const Inertial ball{.mass_kg = half_kg,
                      .inertia = 0.4 * half_kg * support.radius_m * support.radius_m * Eigen::Matrix3d::Identity()};
  NormalizedLink carrier{.name = links.new_link_name(file_stem(support.name) + "_swivel", ""), .inertial = ball};
  carrier.joint = NormalizedJoint{.name = links.new_joint_name(carrier.name + "_joint", ""),
                                  .parent = "base_link",
                                  .T_parent_link = translation(support.center_m + Eigen::Vector3d(trail_m, 0.0, 0.0)),
                                  .is_fixed = false,
                                  .axis = Eigen::Vector3d::UnitZ()};
  NormalizedLink wheel{.name = links.new_link_name(file_stem(support.name) + "_ball", ""), .inertial = ball};
  wheel.joint = NormalizedJoint{.name = links.new_joint_name(wheel.name + "_joint", ""),
                                .parent = carrier.name,
                                .T_parent_link = translation({-trail_m, 0.0, 0.0}),
                                .is_fixed = false};
  wheel.collisions.push_back({.shape = {.type = ShapeType::kSphere, .radius_m = support.radius_m}});
  robot.links.push_back(std::move(carrier));
  robot.links.push_back(std::move(wheel));
}

}  // namespace

void add_casters(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot) {
  const double mass_kg = total_mass_kg(robot);
  strengthen_casters(layout, mass_kg, links, robot);
  for (const Support& support : layout.supports) add_support(layout, support, mass_kg, links, robot);
}

}  // namespace patrol::importer
