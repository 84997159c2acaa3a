#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/gravity.h"
#include "importer/normalizer.h"

namespace patrol::importer {
namespace {

constexpr double kAssumedSpeedRadius_m = 0.1;  // of the smallest wheels at kAssumedSpeed_mps
constexpr double kMaxUnreported = 1.01;        // of the speed of the motors to that of the robot
constexpr double kPlaceholderRatio = 10.0;     // of a speed limit to the assumed one
constexpr double kTorqueReserve = 1.5;  // loads differ, and wheels that skid sideways need the torque of friction

/// Returns the torque of the friction of a tire, N m, if the driven wheels carry the robot.
double traction_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg) {
  return kFriction * mass_kg * kGravity_mps2 * wheel.radius_m / static_cast<double>(num_driven);
}

/// Returns the speed limit of a drive whose file has none: that of small robots falls with the square root of their
/// size.
double assumed_speed_mps(double wheel_radius_m) {
  return kAssumedSpeed_mps * std::sqrt(std::min(1.0, wheel_radius_m / kAssumedSpeedRadius_m));
}

}  // namespace

Motor Normalizer::motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg) {
  Motor motor{.effort_nm = wheel.joint->effort.value_or(0.0), .velocity_radps = wheel.joint->velocity.value_or(0.0)};
  const double traction_nm = traction_of(wheel, num_driven, mass_kg);
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
    const double speed_mps = assumed_speed_mps(wheel.radius_m);
    motor.velocity_radps = speed_mps / wheel.radius_m;
    assume(wheel.joint->name, fmt::format("speed limit {:.3g} rad/s: {:.2g} m/s", motor.velocity_radps, speed_mps),
           "<limit velocity> of the joint");
  }
  return motor;
}

/// Returns the speed of the robot at which a driven wheel reaches its limit. A limit that no robot of its size reaches
/// is taken for a missing one.
double Normalizer::speed_of(const FoundWheel& wheel, const Motor& motor) {
  const double limit_mps = motor.velocity_radps * wheel.radius_m, assumed_mps = assumed_speed_mps(wheel.radius_m);
  if (limit_mps <= kPlaceholderRatio * assumed_mps) return limit_mps;
  assume(wheel.joint->name,
         fmt::format(
             "speed limit {:.4g} rad/s of the file, {:.2g} m/s, is kept for the motor; the robot drives at {:.2g} m/s",
             motor.velocity_radps, limit_mps, assumed_mps),
         "wheel_drive.max_speed_mps");
  return assumed_mps;
}

/// Reduces damping and friction of a driven joint that its motor cannot overcome at full speed, or that brake the
/// robot with more than the friction of the tires.
void Normalizer::reduce_losses(const SourceJoint& joint, double radius_m, double traction_nm, NormalizedJoint& driven) {
  const Motor& motor = *driven.motor;
  const double speed_radps = std::min(motor.velocity_radps, kAssumedSpeed_mps / radius_m);
  const double loss_nm = driven.damping * speed_radps + driven.friction;
  const double limit_nm = std::min(motor.effort_nm, traction_nm);
  if (loss_nm <= limit_nm) return;
  constexpr double kLoss = 0.25;  // to the limit
  const double factor = kLoss * limit_nm / loss_nm;
  driven.damping *= factor;
  driven.friction *= factor;
  assume(joint.name,
         fmt::format(
             "damping and friction take {:.3g} N m at {:.3g} rad/s, more than the {} of {:.3g} N m: reduced to a "
             "quarter of it",
             loss_nm, speed_radps, traction_nm < motor.effort_nm ? "friction of the tire" : "torque limit", limit_nm),
         "<dynamics> and <limit effort velocity> of the joint");
}

/// Returns the range of a steering joint.
JointRange Normalizer::steering_range_of(const SourceJoint& joint) {
  const auto limits = joint.steering_limits();
  if (!limits) {
    assume(joint.name, fmt::format("steering angle is limited to {} rad: the joint has no limits", kSteering_rad),
           joint.type == JointType::kContinuous ? "type revolute and <limit lower upper> of the joint"
                                                : "<limit lower upper> of the joint");
    return {-kSteering_rad, kSteering_rad};
  }
  const auto& [lower, upper] = *limits;
  if (lower > -kMinSteering_rad || upper < kMinSteering_rad) {
    source_.fail(joint.line, joint.name,
                 fmt::format("steering range {:.3g} to {:.3g} rad: must reach at least {} rad to both sides", lower,
                             upper, kMinSteering_rad));
  }
  if (joint.is_endless())
    assume(
        joint.name,
        fmt::format("steering angle is {:.3g} to {:.3g} rad by <limit>, although its type is continuous", lower, upper),
        "type revolute of the joint");
  return {lower, upper};
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
      target.joint->range = steering_range_of(joint);
      Motor motor{joint.effort.value_or(0.0), joint.velocity.value_or(0.0)};
      if (motor.effort_nm <= 0.0) {
        motor.effort_nm = std::max(2.0, kFriction * mass_kg * kGravity_mps2 /
                                            static_cast<double>(found_.wheels.size()) * wheel.width_m);
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

  double max_speed_mps = std::numeric_limits<double>::infinity();
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
      reduce_losses(joint, wheel.radius_m, traction_of(wheel, driven_.size(), mass_kg), *target.joint);
      max_speed_mps = std::min(max_speed_mps, speed_of(wheel, *target.joint->motor));
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
  result_.max_speed_mps = std::min(kAssumedSpeed_mps, max_speed_mps);
  if (max_speed_mps <= kMaxUnreported * kAssumedSpeed_mps) return;
  assume(
      "speed",
      fmt::format("drives at up to {:g} m/s, although the motors reach {:.3g} m/s", kAssumedSpeed_mps, max_speed_mps),
      fmt::format("wheel_drive.max_speed_mps and stack.navigation.local_planner.dwa.max_speed_mps in {}.yaml",
                  result_.name));
}

/// Reports friction coefficients of Gazebo on parts that touch the ground. They are not used: many are tuned for its
/// contact solver, as 0.01 in place of mecanum rollers.
void Normalizer::report_frictions() {
  const auto report = [this](const std::string& link, const std::string& simulated, const std::string& key) {
    const auto found = source_.frictions.find(link);
    if (found == source_.frictions.end()) return;
    const auto& [mu1, mu2] = found->second;
    if (mu1 == kFriction && mu2 == kFriction) return;
    assume(link, fmt::format("friction mu1 = {:g}, mu2 = {:g} of <gazebo> is not used: {}", mu1, mu2, simulated), key);
  };
  for (const FoundWheel& wheel : found_.wheels) {
    for (const SourceLink* link : moving_group(*wheel.joint))
      report(link->name, fmt::format("{} is simulated on all wheels", kFriction),
             fmt::format("wheel_drive.friction in {}.yaml", result_.name));
  }
  for (const Support& support : supports_)
    report(support.link, "it rolls as a ball", "none: casters roll in the simulator");
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

}  // namespace patrol::importer
