#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "importer/normalizer.h"

namespace patrol::importer {
namespace {

constexpr double kTorqueReserve = 1.5;  // loads differ, and wheels that skid sideways need the torque of friction

}  // namespace

Motor Normalizer::motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg) {
  Motor motor{.effort_nm = wheel.joint->effort.value_or(0.0), .velocity_radps = wheel.joint->velocity.value_or(0.0)};
  const double traction_nm = kFriction * mass_kg * kGravity * wheel.radius_m / static_cast<double>(num_driven);
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm = kTorqueReserve * traction_nm;
    assume(wheel.joint->name,
           fmt::format("torque limit {:.3g} N m: {} times that of friction {} on all driven wheels", motor.effort_nm,
                       kTorqueReserve, kFriction),
           "<limit effort> of the joint");
  } else if (motor.effort_nm > 20.0 * traction_nm) {
    assume(wheel.joint->name,
           fmt::format("torque limit {:.3g} N m of the file is kept: {:.0f} times the friction limit", motor.effort_nm,
                       motor.effort_nm / traction_nm),
           "<limit effort> of the joint");
  }
  if (motor.velocity_radps <= 0.0) {
    motor.velocity_radps = kAssumedSpeed_mps / wheel.radius_m;
    assume(wheel.joint->name, fmt::format("speed limit {:.3g} rad/s: {} m/s", motor.velocity_radps, kAssumedSpeed_mps),
           "<limit velocity> of the joint");
  }
  return motor;
}

/// Reduces damping and friction of a driven joint that its motor cannot overcome at its speed limit.
void Normalizer::reduce_losses(const SourceJoint& joint, NormalizedJoint& driven) {
  const Motor& motor = *driven.motor;
  const double loss_nm = driven.damping * motor.velocity_radps + driven.friction;
  if (loss_nm <= motor.effort_nm) return;
  constexpr double kLoss = 0.25;  // to the torque limit
  const double factor = kLoss * motor.effort_nm / loss_nm;
  driven.damping *= factor;
  driven.friction *= factor;
  assume(joint.name,
         fmt::format("damping and friction take {:.3g} N m at the speed limit, more than the torque limit of {:.3g} N "
                     "m: reduced to a quarter of the limit",
                     loss_nm, motor.effort_nm),
         "<dynamics> and <limit effort velocity> of the joint");
}

/// Adds carriers and wheels. The frames of both are parallel to base_link; a wheel's origin is its center.
void Normalizer::add_wheels() {
  double mass_kg = total_mass_kg();
  for (const FoundWheel& wheel : found_.wheels) {
    for (const SourceLink* link : moving_group(*wheel.joint)) mass_kg += link->inertial ? link->inertial->mass_kg : 0.0;
  }
  std::map<const SourceJoint*, std::pair<std::string, Pose3>> carriers;  // joint to link and T_base_carrier
  std::map<const SourceJoint*, Pose3> adjustments;
  for (const FoundWheel& wheel : found_.wheels) {
    const bool is_caster = wheel.carrier_type == CarrierType::kCaster;
    if (wheel.carrier_type == CarrierType::kNone || carriers.contains(wheel.carrier)) continue;
    const SourceJoint& joint = *wheel.carrier;
    const Pose3 T_base_source = T_base(joint.child);
    const Pose3 T_base_carrier = translation(T_base_source.position);
    const Eigen::Vector3d axis = T_base_source.rotation * joint.axis;
    Pose3 T_adjust;
    if (is_caster) {
      const double angle = axle_angle_rad(wheel.axis);
      if (std::abs(angle) > 1e-6) {
        T_adjust = T_base_carrier * Pose3{.rotation = quaternion_from_yaw(-angle)} * T_base_carrier.inverse();
        assume(
            joint.name,
            fmt::format("caster is turned by {:.1f} degrees at zero, so that its axle is along y", -angle * kDegPerRad),
            "<origin rpy> of the joint");
      }
    }
    if (std::abs(axis.z()) < 0.9998) {
      assume(joint.name,
             fmt::format("axis is tilted by {:.1f} degrees and made vertical",
                         std::acos(std::min(1.0, std::abs(axis.z()))) * kDegPerRad),
             "<axis> of the joint");
    }
    adjustments[&joint] = T_adjust;
    NormalizedLink target{.name = link_name(joint.child)};
    target.joint = NormalizedJoint{.name = joint_name(joint.name),
                                   .parent = "base_link",
                                   .T_parent_link = T_base_carrier,
                                   .is_fixed = false,
                                   .axis = {0.0, 0.0, axis.z() > 0.0 ? 1.0 : -1.0},
                                   .damping = joint.damping,
                                   .friction = joint.friction};
    if (!is_caster) {
      JointRange range{joint.lower, joint.upper};
      if (joint.is_endless()) {
        range = {-0.6, 0.6};
        assume(joint.name, "steering angle is limited to 0.6 rad: the joint has no limits",
               "<limit lower upper> of the joint");
      } else if (joint.lower >= joint.upper) {
        source_.fail(joint.line, joint.name,
                     fmt::format("limit lower = {}: must be below upper = {}", joint.lower, joint.upper));
      }
      target.joint->range = range;
      Motor motor{joint.effort.value_or(0.0), joint.velocity.value_or(0.0)};
      if (motor.effort_nm <= 0.0) {
        motor.effort_nm =
            std::max(2.0, kFriction * mass_kg * kGravity / static_cast<double>(found_.wheels.size()) * wheel.width_m);
        assume(joint.name,
               fmt::format("torque limit {:.3g} N m: friction {} on the width of the tire", motor.effort_nm, kFriction),
               "<limit effort> of the joint");
      }
      if (motor.velocity_radps <= 0.0) {
        motor.velocity_radps = 2.0;
        assume(joint.name, "speed limit 2 rad/s", "<limit velocity> of the joint");
      }
      target.joint->motor = motor;
    }
    const std::vector<const SourceLink*> links = moving_group(joint);
    std::vector<Shape> shapes;
    for (const SourceLink* link : links) {
      const Pose3 T_carrier_link = T_base_carrier.inverse() * (T_adjust * T_base(link->name));
      add_visuals(*link, T_carrier_link, target);
      add_collisions(*link, T_carrier_link, false, target);
      for (Shape shape : link->collisions.empty() ? link->visuals : link->collisions) {
        shape.T_link_shape = T_carrier_link * shape.T_link_shape;
        shapes.push_back(shape);
      }
    }
    target.inertial = moving_inertial(links, T_base_carrier, T_adjust, shapes, joint);
    carriers[&joint] = {target.name, T_base_carrier};
    result_.links.push_back(std::move(target));
  }

  double max_speed_mps = kAssumedSpeed_mps;
  for (const FoundWheel& wheel : found_.wheels) {
    const SourceJoint& joint = *wheel.joint;
    const bool has_carrier = wheel.carrier_type != CarrierType::kNone;
    const Pose3 T_adjust = has_carrier ? adjustments.at(wheel.carrier) : Pose3{};
    const Eigen::Vector3d center = T_adjust * wheel.center_m, axis = T_adjust.rotation * wheel.axis;
    const Pose3 T_base_wheel = translation(center);
    const Pose3 T_base_parent = has_carrier ? carriers.at(wheel.carrier).second : Pose3{};
    const double skew = std::abs(axle_angle_rad(axis));
    const double camber = std::asin(std::min(1.0, std::abs((T_root_link_.at(joint.child).rotation * joint.axis).z())));
    if (std::max(skew, camber) > 0.002) {
      assume(joint.name,
             fmt::format("axle is made lateral: toe {:.1f} and camber {:.1f} degrees are left out", skew * kDegPerRad,
                         camber * kDegPerRad),
             "<axis> of the joint");
    }
    NormalizedLink target{.name = link_name(joint.child)};
    target.joint = NormalizedJoint{.name = joint_name(joint.name),
                                   .parent = has_carrier ? carriers.at(wheel.carrier).first : "base_link",
                                   .T_parent_link = T_base_parent.inverse() * T_base_wheel,
                                   .is_fixed = false,
                                   .axis = {0.0, axis.y() > 0.0 ? 1.0 : -1.0, 0.0},
                                   .damping = joint.damping,
                                   .friction = joint.friction};
    if (driven_.contains(&joint)) {
      target.joint->motor = motor_of(wheel, driven_.size(), mass_kg);
      reduce_losses(joint, *target.joint);
      max_speed_mps = std::min(max_speed_mps, target.joint->motor->velocity_radps * wheel.radius_m);
    }
    if (wheel.is_ball)
      assume(joint.child, fmt::format("width {:.3g} m: its shape is a sphere", wheel.width_m),
             "<collision> of the link");
    Shape tread{.type = ShapeType::kCylinder,
                .T_link_shape = {.rotation = quaternion_from_rpy(0.5 * std::numbers::pi, 0.0, 0.0)},
                .radius_m = wheel.radius_m,
                .length_m = wheel.width_m};
    target.collisions.push_back({.shape = tread});
    const std::vector<const SourceLink*> links = moving_group(joint);
    for (const SourceLink* link : links)
      add_visuals(*link, T_base_wheel.inverse() * (T_adjust * T_base(link->name)), target);
    target.inertial = moving_inertial(links, T_base_wheel, T_adjust, {tread}, joint);
    replace_heavy_inertia(wheel, tread, *target.inertial);
    result_.links.push_back(std::move(target));
  }
  result_.max_speed_mps = max_speed_mps;
}

/// Replaces small wheels by balls that roll and swivel if they have neither motor nor vertical joint and are not on the
/// only driven axle: fixed in their direction, they would keep the robot from turning.
void Normalizer::release_fixed_casters() {
  if (result_.drive != DriveType::kDifferential) return;
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, min_y = min_x, max_y = -min_x;
  double radius_m = min_x;  // of the smallest driven wheel
  for (const FoundWheel& wheel : found_.wheels) {
    if (!driven_.contains(wheel.joint)) continue;
    min_x = std::min(min_x, wheel.center_m.x());
    max_x = std::max(max_x, wheel.center_m.x());
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
    radius_m = std::min(radius_m, wheel.radius_m);
  }
  const double near_m = 0.1 * (max_y - min_y), axle_m = 0.5 * (min_x + max_x);
  if (max_x - min_x > near_m) return;
  constexpr double kSmall = 0.9;  // to the radius of a driven wheel
  std::erase_if(found_.wheels, [&](const FoundWheel& wheel) {
    const SourceJoint& joint = *wheel.joint;
    const bool is_caster = wheel.carrier_type == CarrierType::kNone && wheel.num_rollers == 0 &&
                           !driven_.contains(&joint) && wheel.radius_m < kSmall * radius_m &&
                           std::abs(wheel.center_m.x() - axle_m) > near_m;
    if (!is_caster) return false;
    kept_.erase(&joint);
    casters_.insert(&joint);
    for (const SourceLink* link : moving_group(joint)) {
      chassis_.insert(link->name);
      for (std::size_t i = 0; i < link->collisions.size(); ++i) support_shapes_.insert({link->name, i});
    }
    supports_.push_back({.name = joint.child,
                         .center_m = {wheel.center_m.x(), wheel.center_m.y(), ground_m_ + wheel.radius_m},
                         .radius_m = wheel.radius_m,
                         .link = joint.child});
    assume(joint.name,
           fmt::format("is a caster: its wheel is smaller than the driven ones and has no motor, and fixed in its "
                       "direction it would keep the robot from turning; replaced by a ball of radius {:.3g} m that "
                       "rolls and swivels freely, with 3 % of the mass",
                       wheel.radius_m),
           "a continuous vertical joint above the wheel, or <limit effort velocity> of the joint");
    return true;
  });
}

/// Replaces the inertia of a wheel by that of its shape if it resists rolling like a mass beyond all proportion.
void Normalizer::replace_heavy_inertia(const FoundWheel& wheel, const Shape& tread, Inertial& inertial) {
  constexpr double kMaxRatio = 10.0;  // of mass times radius squared; gears and rotors add to that of the wheel
  const Eigen::Matrix3d R = inertial.T_link_inertia.rotation.toRotationMatrix();
  const double moment = (R * inertial.inertia * R.transpose())(1, 1);
  const double rim_kg = moment / (wheel.radius_m * wheel.radius_m);
  if (rim_kg <= kMaxRatio * inertial.mass_kg) return;
  assume(
      wheel.joint->child,
      fmt::format("its moment of inertia {:.3g} kg m2 about the axle is that of {:.3g} kg at its radius of {:.3g} m, "
                  "but its mass is {:.3g} kg: replaced by that of its shape",
                  moment, rim_kg, wheel.radius_m, inertial.mass_kg),
      "<inertia> of the link");
  inertial = solid_inertial({tread}, inertial.mass_kg);
}

/// Finds fixed parts that touch the ground beside the wheels. Boxes and meshes count only if the robot would tip over
/// without them.
void Normalizer::add_supports() {
  double min_x = std::numeric_limits<double>::infinity(), max_x = -min_x, min_y = min_x, max_y = -min_x;
  for (const FoundWheel& wheel : found_.wheels) {
    min_x = std::min(min_x, wheel.center_m.x());
    max_x = std::max(max_x, wheel.center_m.x());
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
  }
  const double gauge_m = max_y - min_y;
  bool needs_support = max_x - min_x < 0.1 * gauge_m && supports_.empty();
  const std::size_t num_casters = supports_.size();
  const auto find = [&](bool with_any_shape) {
    for (const std::string& name : chassis_) {
      const SourceLink& link = source_.link(name);
      const bool is_leaf = name != base_;
      const auto consider = [&](const std::vector<Shape>& shapes, bool is_collision) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          const Shape& shape = shapes[i];
          if (is_collision && support_shapes_.contains({name, i})) continue;
          const bool is_round = shape.type == ShapeType::kSphere || shape.type == ShapeType::kCylinder;
          if (!is_round && !(with_any_shape && is_leaf)) continue;
          const Pose3 T_base_link = T_base(name);
          Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
          for (const Eigen::Vector3d& point : outline(shape)) {
            lower = lower.cwiseMin(T_base_link * point);
            upper = upper.cwiseMax(T_base_link * point);
          }
          double radius_m = 0.5 * (upper - lower).minCoeff();
          double bottom_m = lower.z();
          if (shape.type == ShapeType::kSphere) {
            radius_m = shape.radius_m;
            bottom_m = (T_base_link * shape.T_link_shape.position).z() - radius_m;
          } else if (shape.type == ShapeType::kCylinder) {
            const Eigen::Vector3d axis =
                T_base_link.rotation * (shape.T_link_shape.rotation * Eigen::Vector3d::UnitZ());
            const double lateral = std::hypot(axis.x(), axis.y());
            radius_m = std::abs(axis.z()) < 0.1 ? shape.radius_m : std::min(shape.radius_m, 0.5 * shape.length_m);
            bottom_m = (T_base_link * shape.T_link_shape.position).z() - shape.radius_m * lateral -
                       0.5 * shape.length_m * std::abs(axis.z());
          }
          if (!is_round)
            radius_m = std::max(radius_m, 0.25 * found_.wheels.front().radius_m);  // a ball for its contact
          if (!is_near_ground(bottom_m) || radius_m <= 0.0) continue;
          const Eigen::Vector3d middle = 0.5 * (lower + upper);
          if (!is_round && std::max(upper.x() - lower.x(), upper.y() - lower.y()) > gauge_m) continue;
          if (is_collision) support_shapes_.insert({name, i});
          supports_.push_back({.name = name,
                               .center_m = {middle.x(), middle.y(), ground_m_ + radius_m},
                               .radius_m = radius_m,
                               .link = name == base_ ? "" : name});
          if (std::abs(middle.x() - min_x) > 0.1 * gauge_m) needs_support = false;
        }
      };
      consider(link.collisions, true);
      if (link.collisions.empty()) consider(link.visuals, false);
    }
  };
  find(false);
  if (needs_support) find(true);
  for (std::size_t i = num_casters; i < supports_.size(); ++i) {
    const Support& support = supports_[i];
    assume(support.name,
           fmt::format("is fixed and touches the ground: replaced by a ball of radius {:.3g} m that rolls and swivels "
                       "freely, with 3 % of the mass",
                       support.radius_m),
           "a wheel on two continuous joints");
  }
  if (!needs_support) return;
  // The robot would tip over: a ball below the chassis, on the side of the center of mass.
  std::vector<std::pair<Pose3, Inertial>> parts;
  double front_m = max_x, rear_m = min_x;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    if (link.inertial && link.inertial->mass_kg > 0.0) parts.push_back({T_base(name), to_inertial(*link.inertial)});
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        front_m = std::max(front_m, (T_base(name) * point).x());
        rear_m = std::min(rear_m, (T_base(name) * point).x());
      }
    }
  }
  const double axle_m = 0.5 * (min_x + max_x);
  const double center_m = parts.empty() ? axle_m : combine(parts).T_link_inertia.position.x();
  const double radius_m = 0.25 * found_.wheels.front().radius_m;
  std::vector<double> positions_m;
  if (center_m <= axle_m + 0.02) positions_m.push_back(axle_m + 0.8 * std::min(rear_m - axle_m, -2.0 * radius_m));
  if (center_m >= axle_m - 0.02) positions_m.push_back(axle_m + 0.8 * std::max(front_m - axle_m, 2.0 * radius_m));
  for (const double x : positions_m) {
    supports_.push_back({.name = "support",
                         .center_m = {x, 0.5 * (min_y + max_y), ground_m_ + radius_m},
                         .radius_m = radius_m,
                         .link = ""});
    assume("support",
           fmt::format(
               "a ball of radius {:.3g} m at x = {:.3f} m keeps the robot upright: the file has one axle and no caster",
               radius_m, x),
           "a caster, or a fixed sphere that touches the ground");
  }
}

/// Takes mass from the chassis and returns it: at most a fifth of the mass of base_link.
double Normalizer::take_from_base(double wanted_kg) {
  Inertial& inertial = *base().inertial;
  const double taken_kg = std::min(wanted_kg, 0.2 * inertial.mass_kg);
  inertial.inertia *= 1.0 - taken_kg / inertial.mass_kg;
  inertial.mass_kg -= taken_kg;
  return taken_kg;
}

/// Gives the carriers and wheels of very light casters mass of the chassis, and an inertia of twice this mass at the
/// radius of the wheel: their contact is unstable otherwise.
void Normalizer::strengthen_casters(double robot_mass_kg) {
  std::map<std::string, double> parts;  // name to radius of the wheel
  for (const FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type != CarrierType::kCaster) continue;
    for (const SourceJoint* joint : {wheel.joint, wheel.carrier}) parts[link_name(joint->child)] = wheel.radius_m;
  }
  constexpr double kLight = 0.3;    // to the mass that a part gets
  constexpr double kInertia = 2.0;  // to mass times radius squared
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(parts.size());
  for (NormalizedLink& link : result_.links) {
    if (!parts.contains(link.name) || link.inertial->mass_kg >= kLight * wanted_kg) continue;
    Inertial& inertial = *link.inertial;
    const double before_kg = inertial.mass_kg;
    inertial.mass_kg += take_from_base(wanted_kg - before_kg);
    const double radius_m = parts.at(link.name), moment = kInertia * inertial.mass_kg * radius_m * radius_m;
    inertial.inertia = moment * Eigen::Matrix3d::Identity();
    assume(
        link.name,
        fmt::format("its mass of {:.3g} kg is raised to {:.3g} kg, taken from the chassis, and its moments of inertia "
                    "to {:.3g} kg m2: the contact of lighter casters is unstable in the simulation",
                    before_kg, inertial.mass_kg, moment),
        "<mass> of the link");
  }
}

/// Adds a ball that rolls about y in a carrier that swivels about z, with half the radius of trail.
void Normalizer::add_support(const Support& support, double robot_mass_kg) {
  // Lighter balls make the contact of the simulation unstable.
  const double wanted_kg = kSupportMassRatio * robot_mass_kg / static_cast<double>(supports_.size());
  double mass_kg = 0.0;
  if (!support.link.empty()) {  // the mass of a light part goes to the ball
    for (NormalizedLink& link : result_.links) {
      if (link.name != link_name(support.link) || !link.inertial || link.inertial->mass_kg > 1.5 * wanted_kg) continue;
      mass_kg = link.inertial->mass_kg;
      link.inertial.reset();
    }
  }
  if (mass_kg < wanted_kg) mass_kg += take_from_base(wanted_kg - mass_kg);
  const double half_kg = 0.5 * mass_kg, trail_m = 0.5 * support.radius_m;
  const Inertial ball{.mass_kg = half_kg,
                      .inertia = 0.4 * half_kg * support.radius_m * support.radius_m * Eigen::Matrix3d::Identity()};
  NormalizedLink carrier{.name = unique(used_links_, file_stem(support.name) + "_swivel", ""), .inertial = ball};
  carrier.joint = NormalizedJoint{.name = unique(used_joints_, carrier.name + "_joint", ""),
                                  .parent = "base_link",
                                  .T_parent_link = translation(support.center_m + Eigen::Vector3d(trail_m, 0.0, 0.0)),
                                  .is_fixed = false,
                                  .axis = Eigen::Vector3d::UnitZ()};
  NormalizedLink wheel{.name = unique(used_links_, file_stem(support.name) + "_ball", ""), .inertial = ball};
  wheel.joint = NormalizedJoint{.name = unique(used_joints_, wheel.name + "_joint", ""),
                                .parent = carrier.name,
                                .T_parent_link = translation({-trail_m, 0.0, 0.0}),
                                .is_fixed = false};
  wheel.collisions.push_back({.shape = {.type = ShapeType::kSphere, .radius_m = support.radius_m}});
  result_.links.push_back(std::move(carrier));
  result_.links.push_back(std::move(wheel));
}

}  // namespace patrol::importer
