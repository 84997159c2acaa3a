#include "importer/robot/normalize_legs.h"

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/gravity.h"
#include "importer/robot/foot_finder.h"
#include "importer/robot/normalize_chassis.h"
#include "importer/robot/normalize_inertias.h"

namespace patrol::importer {
namespace {

/// Joint of a leg in the result.
struct LegJoint {
  const SourceJoint* joint = nullptr;
  std::size_t link = 0;  ///< index of its child in the result
  double leg_m = 0.0;    ///< length of the leg
};

/// Returns the torque and speed limits of a joint of a leg.
Motor motor_of_leg(const SourceJoint& joint, double mass_kg, double leg_m, std::vector<Assumption>& rows) {
  // Ratios of the motors of walking robots of 12 to 50 kg to weight and length of the leg.
  constexpr double kTorqueRatio = 0.42, kSpeed_radps = 20.0;
  constexpr double kPlaceholderTorque = 20.0;  // to that of these motors
  Motor motor{.effort_nm = joint.effort.value_or(0.0), .velocity_radps = joint.velocity.value_or(0.0)};
  const double usual_nm = kTorqueRatio * mass_kg * kGravity_mps2 * leg_m;
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm = usual_nm;
    rows.push_back(
        {joint.name,
         fmt::format("torque limit {:.3g} N m: {} of weight times length of the leg", motor.effort_nm, kTorqueRatio),
         "<limit effort> of the joint"});
  } else if (motor.effort_nm > kPlaceholderTorque * usual_nm) {
    rows.push_back(
        {joint.name,
         fmt::format("torque limit {:.4g} N m of the file is kept: {:.0f} times that of walking robots of its size",
                     motor.effort_nm, motor.effort_nm / usual_nm),
         "<limit effort> of the joint"});
  }
  if (motor.velocity_radps <= 0.0) {
    motor.velocity_radps = kSpeed_radps;
    rows.push_back({joint.name, fmt::format("speed limit {} rad/s", kSpeed_radps), "<limit velocity> of the joint"});
  }
  return motor;
}

JointRange range_of_leg(const SourceRobot& source, const SourceJoint& joint, std::vector<Assumption>& rows) {
  if (joint.type == JointType::kContinuous) {
    rows.push_back({joint.name, "is limited to a half turn to either side: the joint has no limits",
                    "type revolute and <limit lower upper> of the joint"});
    return {-std::numbers::pi, std::numbers::pi};
  }
  if (joint.lower >= joint.upper) {
    source.fail(joint.line, joint.name,
                fmt::format("limit lower = {}: must be below upper = {}", joint.lower, joint.upper));
  }
  return {joint.lower, joint.upper};
}

/// Adds the link below a joint of a leg. `foot`: that of the leg if this is its last link, else null.
void add_leg_link(const RobotLayout& layout, const SourceJoint& joint, const std::string& parent,
                  const Pose3& T_base_parent, const Foot* foot, LinkBuilder& links, NormalizedRobot& robot) {
  std::vector<Assumption>& rows = robot.assumptions;
  const Pose3 T_base_link = layout.T_base(joint.child);
  NormalizedLink target{.name = links.link_name(joint.child)};
  target.joint = NormalizedJoint{.name = links.joint_name(joint.name),
                                 .parent = parent,
                                 .T_parent_link = T_base_parent.inverse() * T_base_link,
                                 .is_fixed = false,
                                 .axis = joint.axis,
                                 .range = range_of_leg(layout.source, joint, rows)};
  const std::vector<const SourceLink*> group = layout.moving_group(joint);
  std::vector<Shape> shapes;
  for (const SourceLink* link : group) {
    const Pose3 T_target_link = T_base_link.inverse() * layout.T_base(link->name);
    links.add_visuals(*link, T_target_link, target);
    for (Shape shape : bounding_shapes(*link)) {
      shape.T_link_shape = T_target_link * shape.T_link_shape;
      shapes.push_back(shape);
    }
    if (foot != nullptr && (!foot->is_sphere || link->name == foot->link)) continue;
    links.add_collisions(*link, T_target_link, false, target);
  }
  if (foot != nullptr && foot->is_sphere) keep_foot_free(*foot, joint, target, rows);
  if (foot != nullptr && target.collisions.empty()) target.collisions.push_back({.shape = shank_of(*foot)});
  target.inertial = moving_inertial(layout, group, T_base_link, {}, shapes, joint, rows);
  robot.links.push_back(std::move(target));
}

/// Adds the ball at the end of a leg to the last link of the result. `knee`: link of the file that has it.
void add_foot(const Foot& foot, const std::string& knee, LinkBuilder& links, NormalizedRobot& robot) {
  const std::string parent = robot.links.back().name;
  NormalizedLink tip{.name = links.new_link_name(parent + "_foot", "_ball")};
  robot.source_links[tip.name] = knee;
  tip.joint = NormalizedJoint{.name = links.new_joint_name(tip.name + "_joint", "_ball"),
                              .parent = parent,
                              .T_parent_link = translation(foot.center_m)};
  tip.collisions.push_back({.shape = {.type = ShapeType::kSphere, .radius_m = foot.radius_m}});
  robot.links.push_back(std::move(tip));
}

/// Adds a leg without its motors; returns its joints.
std::vector<LegJoint> add_leg(const RobotLayout& layout, const FoundLeg& leg, LinkBuilder& links,
                              NormalizedRobot& robot) {
  const Foot foot = find_foot(layout, leg, robot.assumptions);
  const double thigh_m =
      (layout.T_base(leg.joints[2]->child).position - layout.T_base(leg.joints[1]->child).position).norm();
  const double leg_m = thigh_m + foot.center_m.norm();
  robot.leg_m = std::max(robot.leg_m, leg_m);
  std::vector<LegJoint> added;
  std::string parent = "base_link";
  Pose3 T_base_parent;
  for (const SourceJoint* joint : leg.joints) {
    added.push_back({joint, robot.links.size(), leg_m});
    const bool is_last = joint == leg.joints.back();
    add_leg_link(layout, *joint, parent, T_base_parent, is_last ? &foot : nullptr, links, robot);
    parent = robot.links.back().name;
    T_base_parent = layout.T_base(joint->child);
  }
  add_foot(foot, leg.joints.back()->child, links, robot);
  return added;
}

/// Reports the gait, and a mass for which it is not tested.
void report_gait(double mass_kg, NormalizedRobot& robot) {
  robot.assumptions.push_back(
      {"gait",
       fmt::format("walks with the gait of models/quadruped, scaled to {:.3g} kg and legs of {:.3g} m", mass_kg,
                   robot.leg_m),
       "locomotion in the settings file"});
  constexpr double kMinTested_kg = 6.0, kMaxTested_kg = 60.0;  // models/README.md
  if (mass_kg >= kMinTested_kg && mass_kg <= kMaxTested_kg) return;
  robot.assumptions.push_back(
      {"mass",
       fmt::format("{:.3g} kg are outside of the tested range of robots with legs, {:g} to {:g} kg: patrol check "
                   "shows whether it walks",
                   mass_kg, kMinTested_kg, kMaxTested_kg),
       "<mass> of the links"});
}

}  // namespace

void add_legs(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot) {
  std::vector<LegJoint> joints;
  for (const FoundLeg& leg : layout.legs) {
    const std::vector<LegJoint> added = add_leg(layout, leg, links, robot);
    joints.insert(joints.end(), added.begin(), added.end());
  }
  const double mass_kg = total_mass_kg(robot);  // with the masses that are assumed for links of the legs
  for (const LegJoint& each : joints)
    robot.links[each.link].joint->motor = motor_of_leg(*each.joint, mass_kg, each.leg_m, robot.assumptions);
  report_gait(mass_kg, robot);
}

}  // namespace patrol::importer
