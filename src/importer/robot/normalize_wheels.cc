#include "importer/robot/normalize_wheels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/robot/normalize_chassis.h"
#include "importer/robot/normalize_inertias.h"
#include "importer/robot/wheel_motors.h"

namespace patrol::importer {
namespace {

constexpr double kMaxUnreported = 1.01;  // of the speed of the motors to that of the robot

/// Carrier in the result.
struct AddedCarrier {
  std::string link = "base_link";
  Pose3 T_base_carrier = {};
  Pose3 T_adjust = {};  ///< motion of its links in the base that turns the axle of a caster along y
};

/// Returns the mass of the robot: of the links so far, and of the wheels.
double mass_with_wheels_kg(const RobotLayout& layout, const NormalizedRobot& robot) {
  double mass_kg = total_mass_kg(robot);
  for (const FoundWheel& wheel : layout.found.wheels) {
    for (const SourceLink* link : layout.moving_group(*wheel.joint))
      mass_kg += link->inertial ? link->inertial->mass_kg : 0.0;
  }
  return mass_kg;
}

/// Returns the motion in the base that turns a caster until its axle is along y.
Pose3 turn_of_caster(const FoundWheel& wheel, const Pose3& T_base_carrier, std::vector<Assumption>& rows) {
  const double angle = axle_angle_rad(wheel.axis);
  if (wheel.carrier_type != CarrierType::kCaster || std::abs(angle) <= 1e-6) return {};
  rows.push_back(
      {wheel.carrier->name,
       fmt::format("caster is turned by {:.1f} degrees at zero, so that its axle is along y", -angle * kDegPerRad),
       "<origin rpy> of the joint"});
  return T_base_carrier * Pose3{.rotation = quaternion_from_yaw(-angle)} * T_base_carrier.inverse();
}

/// Adds the shapes of the links of a carrier; returns its shapes, in its frame.
std::vector<Shape> add_carrier_shapes(const RobotLayout& layout, const std::vector<const SourceLink*>& group,
                                      const AddedCarrier& carrier, LinkBuilder& links, NormalizedLink& target) {
  std::vector<Shape> shapes;
  for (const SourceLink* link : group) {
    const Pose3 T_carrier_link = carrier.T_base_carrier.inverse() * (carrier.T_adjust * layout.T_base(link->name));
    links.add_visuals(*link, T_carrier_link, target);
    links.add_collisions(*link, T_carrier_link, false, target);
    for (Shape shape : bounding_shapes(*link)) {
      shape.T_link_shape = T_carrier_link * shape.T_link_shape;
      shapes.push_back(shape);
    }
  }
  return shapes;
}

/// Adds the carrier of a wheel: a caster or a steered one.
AddedCarrier add_carrier(const RobotLayout& layout, const FoundWheel& wheel, double mass_kg, LinkBuilder& links,
                         NormalizedRobot& robot) {
  std::vector<Assumption>& rows = robot.assumptions;
  const SourceJoint& joint = *wheel.carrier;
  const Pose3 T_base_source = layout.T_base(joint.child);
  const Eigen::Vector3d axis = T_base_source.rotation * joint.axis;
  AddedCarrier carrier{.T_base_carrier = translation(T_base_source.position)};
  carrier.T_adjust = turn_of_caster(wheel, carrier.T_base_carrier, rows);
  if (std::abs(axis.z()) < 0.9998) {
    rows.push_back({joint.name,
                    fmt::format("axis is tilted by {:.1f} degrees and made vertical",
                                std::acos(std::min(1.0, std::abs(axis.z()))) * kDegPerRad),
                    "<axis> of the joint"});
  }
  carrier.link = links.link_name(joint.child);
  NormalizedLink target{.name = carrier.link};
  target.joint = NormalizedJoint{.name = links.joint_name(joint.name),
                                 .parent = "base_link",
                                 .T_parent_link = carrier.T_base_carrier,
                                 .is_fixed = false,
                                 .axis = {0.0, 0.0, axis.z() > 0.0 ? 1.0 : -1.0},
                                 .damping = joint.damping,
                                 .friction = joint.friction};
  if (wheel.carrier_type != CarrierType::kCaster) {
    target.joint->range = steering_range_of(layout.source, joint, rows);
    target.joint->motor = steering_motor_of(wheel, layout.found.wheels.size(), mass_kg, rows);
  }
  const std::vector<const SourceLink*> group = layout.moving_group(joint);
  const std::vector<Shape> shapes = add_carrier_shapes(layout, group, carrier, links, target);
  target.inertial = moving_inertial(layout, group, carrier.T_base_carrier, carrier.T_adjust, shapes, joint, rows);
  robot.links.push_back(std::move(target));
  return carrier;
}

/// Reports an axle that is not lateral in the file. `axis` is that of the wheel in the base.
void report_skew(const RobotLayout& layout, const SourceJoint& joint, const Eigen::Vector3d& axis,
                 std::vector<Assumption>& rows) {
  const double skew = std::abs(axle_angle_rad(axis));
  const double camber =
      std::asin(std::min(1.0, std::abs((layout.T_root_link.at(joint.child).rotation * joint.axis).z())));
  if (std::max(skew, camber) <= 0.002) return;
  rows.push_back({joint.name,
                  fmt::format("axle is made lateral: toe {:.1f} and camber {:.1f} degrees are left out",
                              skew * kDegPerRad, camber * kDegPerRad),
                  "<axis> of the joint"});
}

/// Replaces the inertia of a wheel by that of its shape if it resists rolling like a mass beyond all proportion.
void replace_heavy_inertia(const FoundWheel& wheel, const Shape& tread, Inertial& inertial,
                           std::vector<Assumption>& rows) {
  constexpr double kMaxRatio = 10.0;  // of mass times radius squared; gears and rotors add to that of the wheel
  const Eigen::Matrix3d R = inertial.T_link_inertia.rotation.toRotationMatrix();
  const double moment = (R * inertial.inertia * R.transpose())(1, 1);
  const double rim_kg = moment / (wheel.radius_m * wheel.radius_m);
  if (rim_kg <= kMaxRatio * inertial.mass_kg) return;
  rows.push_back(
      {wheel.joint->child,
       fmt::format("its moment of inertia {:.3g} kg m2 about the axle is that of {:.3g} kg at its radius of {:.3g} m, "
                   "but its mass is {:.3g} kg: replaced by that of its shape",
                   moment, rim_kg, wheel.radius_m, inertial.mass_kg),
       "<inertia> of the link"});
  inertial = solid_inertial({tread}, inertial.mass_kg);
}

/// Adds a wheel below its carrier or base_link. Returns the speed of the robot that its motor reaches; infinite without
/// a motor.
double add_wheel(const RobotLayout& layout, const FoundWheel& wheel, const AddedCarrier& carrier, double mass_kg,
                 LinkBuilder& links, NormalizedRobot& robot) {
  std::vector<Assumption>& rows = robot.assumptions;
  const SourceJoint& joint = *wheel.joint;
  const Eigen::Vector3d axis = carrier.T_adjust.rotation * wheel.axis;
  const Pose3 T_base_wheel = translation(carrier.T_adjust * wheel.center_m);
  report_skew(layout, joint, axis, rows);
  NormalizedLink target{.name = links.link_name(joint.child)};
  target.joint = NormalizedJoint{.name = links.joint_name(joint.name),
                                 .parent = carrier.link,
                                 .T_parent_link = carrier.T_base_carrier.inverse() * T_base_wheel,
                                 .is_fixed = false,
                                 .axis = {0.0, axis.y() > 0.0 ? 1.0 : -1.0, 0.0},
                                 .damping = joint.damping,
                                 .friction = joint.friction};
  double speed_mps = std::numeric_limits<double>::infinity();
  if (layout.driven.contains(&joint)) {
    target.joint->motor = motor_of(wheel, layout.driven.size(), mass_kg, rows);
    reduce_losses(wheel, layout.driven.size(), mass_kg, *target.joint, rows);
    speed_mps = speed_of(wheel, *target.joint->motor, rows);
  }
  if (wheel.is_ball) {
    rows.push_back(
        {joint.child, fmt::format("width {:.3g} m: its shape is a sphere", wheel.width_m), "<collision> of the link"});
  }
  const Shape tread{.type = ShapeType::kCylinder,
                    .T_link_shape = {.rotation = quaternion_from_rpy(0.5 * std::numbers::pi, 0.0, 0.0)},
                    .radius_m = wheel.radius_m,
                    .length_m = wheel.width_m};
  target.collisions.push_back({.shape = tread});
  const std::vector<const SourceLink*> group = layout.moving_group(joint);
  for (const SourceLink* link : group)
    links.add_visuals(*link, T_base_wheel.inverse() * (carrier.T_adjust * layout.T_base(link->name)), target);
  target.inertial = moving_inertial(layout, group, T_base_wheel, carrier.T_adjust, {tread}, joint, rows);
  replace_heavy_inertia(wheel, tread, *target.inertial, rows);
  robot.links.push_back(std::move(target));
  return speed_mps;
}

}  // namespace

void add_wheels(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot) {
  const double mass_kg = mass_with_wheels_kg(layout, robot);
  std::map<const SourceJoint*, AddedCarrier> carriers;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kNone || carriers.contains(wheel.carrier)) continue;
    carriers[wheel.carrier] = add_carrier(layout, wheel, mass_kg, links, robot);
  }
  double max_speed_mps = std::numeric_limits<double>::infinity();
  for (const FoundWheel& wheel : layout.found.wheels) {
    const AddedCarrier carrier = wheel.carrier_type != CarrierType::kNone ? carriers.at(wheel.carrier) : AddedCarrier{};
    max_speed_mps = std::min(max_speed_mps, add_wheel(layout, wheel, carrier, mass_kg, links, robot));
  }
  robot.max_speed_mps = std::min(kAssumedSpeed_mps, max_speed_mps);
  if (max_speed_mps <= kMaxUnreported * kAssumedSpeed_mps) return;
  robot.assumptions.push_back(
      {"speed",
       fmt::format("drives at up to {:g} m/s, although the motors reach {:.3g} m/s", kAssumedSpeed_mps, max_speed_mps),
       fmt::format("wheel_drive.max_speed_mps and stack.navigation.local_planner.dwa.max_speed_mps in {}.yaml",
                   robot.name)});
}

void report_frictions(const RobotLayout& layout, NormalizedRobot& robot) {
  const auto report = [&layout, &robot](const std::string& link, const std::string& simulated, const std::string& key) {
    const auto found = layout.source.frictions.find(link);
    if (found == layout.source.frictions.end()) return;
    const auto& [mu1, mu2] = found->second;
    if (mu1 == kFriction && mu2 == kFriction) return;
    robot.assumptions.push_back(
        {link, fmt::format("friction mu1 = {:g}, mu2 = {:g} of <gazebo> is not used: {}", mu1, mu2, simulated), key});
  };
  for (const FoundWheel& wheel : layout.found.wheels) {
    for (const SourceLink* link : layout.moving_group(*wheel.joint))
      report(link->name, fmt::format("{} is simulated on all wheels", kFriction),
             fmt::format("wheel_drive.friction in {}.yaml", robot.name));
  }
  for (const Support& support : layout.supports)
    report(support.link, "it rolls as a ball", "none: casters roll in the simulator");
}

}  // namespace patrol::importer
