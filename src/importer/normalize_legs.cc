#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "core/gravity.h"
#include "importer/normalizer.h"

namespace patrol::importer {
namespace {

constexpr double kMinFoot_m = 0.008, kMaxFoot_m = 0.08;

/// Returns the rotation that turns z along a direction.
Eigen::Quaterniond along(const Eigen::Vector3d& direction) {
  return rotation_between(Eigen::Vector3d::UnitZ(), direction);
}

}  // namespace

/// Chooses the frame base_link: level, x along the file's x or by option, in the middle of the first joints of the
/// legs.
void Normalizer::choose_legged_frame() {
  level_base();
  const std::map<std::string, double> yaws = {
      {"x", 0.0}, {"y", 0.5 * std::numbers::pi}, {"-x", std::numbers::pi}, {"-y", -0.5 * std::numbers::pi}};
  const SourceJoint& knee = *legs_.front().joints.back();
  const Eigen::Vector3d knee_axis =
      T_root_base_.rotation.conjugate() * (T_root_link_.at(knee.child).rotation * knee.axis);
  double yaw = 0.0;
  if (!options_.forward.empty()) {
    yaw = yaws.at(options_.forward);
  } else if (std::abs(knee_axis.x()) > std::abs(knee_axis.y())) {
    yaw = 0.5 * std::numbers::pi;
    assume("base_link",
           "is turned by 90 degrees: the knees turn about y, and the robot walks forward along +y of the file",
           "--forward x, -x, y or -y");
  }
  if (yaw != 0.0) T_root_base_.rotation = T_root_base_.rotation * quaternion_from_yaw(yaw);

  check_upright();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const FoundLeg& leg : legs_)
    center += T_base(leg.joints.front()->child).position / static_cast<double>(legs_.size());
  constexpr double kCentered_m = 0.02;
  if (center.norm() > kCentered_m) {
    T_root_base_.position = T_root_base_ * center;
    assume("base_link",
           fmt::format("is moved by {:.3f}, {:.3f}, {:.3f} m to the middle of the first joints of the legs", center.x(),
                       center.y(), center.z()),
           "--base-link LINK");
  }
}

/// Refuses a robot whose first joints of the legs are above each other rather than beside each other.
void Normalizer::check_upright() const {
  Eigen::AlignedBox3d box;
  for (const FoundLeg& leg : legs_) box.extend(T_base(leg.joints.front()->child).position);
  const Eigen::Vector3d size = box.sizes();
  if (size.z() <= std::min(size.x(), size.y())) return;
  const SourceJoint& joint = *legs_.front().joints.front();
  source_.fail(
      joint.line, joint.name,
      fmt::format("the first joints of the legs are {:.2f} m apart in height, but only {:.2f} m to the side: z "
                  "of {} must be up: add a root link with a fixed joint that turns the robot",
                  size.z(), std::min(size.x(), size.y()), base_));
}

/// Finds the foot of a leg in the frame of its last joint: the sphere at its end, or a ball in the end of its shapes.
Normalizer::Foot Normalizer::find_foot(const FoundLeg& leg) {
  const SourceJoint& knee = *leg.joints.back();
  const Pose3 T_base_knee = T_base(knee.child);
  Foot foot;
  double sphere_m = -1.0, shape_m = 0.0;
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> all;
  bool has_collision = false;
  const std::vector<const SourceLink*> links = moving_group(knee);
  for (const SourceLink* link : links) has_collision = has_collision || !link->collisions.empty();
  for (const SourceLink* link : links) {
    const Pose3 T_knee_link = T_base_knee.inverse() * T_base(link->name);
    for (const Shape& shape : has_collision ? link->collisions : link->visuals) {
      const Eigen::Vector3d center = T_knee_link * shape.T_link_shape.position;
      if (shape.type == ShapeType::kSphere) {
        const double reach_m = center.norm() + shape.radius_m;
        if (reach_m <= sphere_m) continue;
        sphere_m = reach_m;
        foot = {.center_m = center, .radius_m = shape.radius_m, .link = link->name, .is_sphere = true};
        continue;
      }
      for (const Eigen::Vector3d& point : outline(shape)) {
        all.push_back(T_knee_link * point);
        if (all.back().norm() <= shape_m) continue;
        shape_m = all.back().norm();
        end = all.back();
      }
    }
  }
  if (foot.is_sphere && shape_m <= sphere_m + 0.5 * foot.radius_m) return foot;
  if (all.empty()) {
    source_.fail(source_.link(knee.child).line, knee.child,
                 "the last link of a leg has neither shapes nor a foot: it must have a <collision>");
  }
  // The foot is as thick as the last tenth of the leg.
  constexpr double kTip = 0.9;
  Eigen::Vector3d direction = end.normalized();
  const double reach_m = shape_m;
  const auto tip_box = [&](const Eigen::Matrix3d& R_tip_knee) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : all) {
      if (p.dot(direction) > kTip * reach_m) box.extend(R_tip_knee * p);
    }
    return box;
  };
  direction = tip_box(Eigen::Matrix3d::Identity()).center().normalized();
  Eigen::Matrix3d R_tip_knee;  // z along the leg, y about along the axis of the knee
  R_tip_knee.row(0) = knee.axis.cross(direction).normalized();
  R_tip_knee.row(1) = direction.cross(Eigen::Vector3d(R_tip_knee.row(0)));
  R_tip_knee.row(2) = direction;
  const Eigen::AlignedBox3d tip = tip_box(R_tip_knee);
  const double radius_m =
      std::clamp(0.5 * tip.sizes().head<2>().maxCoeff(), kMinFoot_m, std::min(kMaxFoot_m, 0.15 * reach_m));
  const Eigen::Vector3d center(tip.center().x(), tip.center().y(), tip.max().z() - radius_m);
  foot = {.center_m = R_tip_knee.transpose() * center, .radius_m = radius_m, .link = "", .is_sphere = false};
  assume(
      knee.child,
      fmt::format("its foot is a ball of radius {:.3f} m in the end of its shapes; the rest of the link is a cylinder",
                  radius_m),
      "<collision> with a <sphere> at the end of the leg");
  return foot;
}

/// Returns the torque and speed limits of a joint of a leg.
Motor Normalizer::motor_of_leg(const SourceJoint& joint, double mass_kg, double leg_m) {
  // Ratios of the motors of walking robots of 12 to 50 kg to weight and length of the leg.
  constexpr double kTorqueRatio = 0.42, kSpeed_radps = 20.0;
  constexpr double kPlaceholderTorque = 20.0;  // to that of these motors
  Motor motor{.effort_nm = joint.effort.value_or(0.0), .velocity_radps = joint.velocity.value_or(0.0)};
  const double usual_nm = kTorqueRatio * mass_kg * kGravity_mps2 * leg_m;
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm = usual_nm;
    assume(joint.name,
           fmt::format("torque limit {:.3g} N m: {} of weight times length of the leg", motor.effort_nm, kTorqueRatio),
           "<limit effort> of the joint");
  } else if (motor.effort_nm > kPlaceholderTorque * usual_nm) {
    assume(joint.name,
           fmt::format("torque limit {:.4g} N m of the file is kept: {:.0f} times that of walking robots of its size",
                       motor.effort_nm, motor.effort_nm / usual_nm),
           "<limit effort> of the joint");
  }
  if (motor.velocity_radps <= 0.0) {
    motor.velocity_radps = kSpeed_radps;
    assume(joint.name, fmt::format("speed limit {} rad/s", kSpeed_radps), "<limit velocity> of the joint");
  }
  return motor;
}

/// Adds three links for each leg, in the frames of the file, and its foot.
void Normalizer::add_legs() {
  struct LegJoint {
    const SourceJoint* joint = nullptr;
    std::size_t link = 0;  // index in the result
    double leg_m = 0.0;
  };
  std::vector<LegJoint> leg_joints;
  for (const FoundLeg& leg : legs_) {
    const Foot foot = find_foot(leg);
    const double leg_m =
        (T_base(leg.joints[2]->child).position - T_base(leg.joints[1]->child).position).norm() + foot.center_m.norm();
    result_.leg_m = std::max(result_.leg_m, leg_m);
    std::string parent = "base_link";
    Pose3 T_base_parent;
    for (std::size_t i = 0; i < leg.joints.size(); ++i) {
      const SourceJoint& joint = *leg.joints[i];
      const bool is_last = i + 1 == leg.joints.size();
      const Pose3 T_base_link = T_base(joint.child);
      NormalizedLink target{.name = link_name(joint.child)};
      target.joint = NormalizedJoint{.name = joint_name(joint.name),
                                     .parent = parent,
                                     .T_parent_link = T_base_parent.inverse() * T_base_link,
                                     .is_fixed = false,
                                     .axis = joint.axis,
                                     .range = range_of_leg(joint)};
      leg_joints.push_back({&joint, result_.links.size(), leg_m});
      const std::vector<const SourceLink*> links = moving_group(joint);
      std::vector<Shape> shapes;
      for (const SourceLink* link : links) {
        const Pose3 T_target_link = T_base_link.inverse() * T_base(link->name);
        add_visuals(*link, T_target_link, target);
        for (Shape shape : link->collisions.empty() ? link->visuals : link->collisions) {
          shape.T_link_shape = T_target_link * shape.T_link_shape;
          shapes.push_back(shape);
        }
        if (is_last && (!foot.is_sphere || link->name == foot.link)) continue;
        add_collisions(*link, T_target_link, false, target);
      }
      if (is_last && foot.is_sphere) keep_foot_free(foot, joint, target);
      if (is_last && target.collisions.empty()) target.collisions.push_back({.shape = shank_of(foot)});
      target.inertial = moving_inertial(links, T_base_link, {}, shapes, joint);
      parent = target.name;
      T_base_parent = T_base_link;
      result_.links.push_back(std::move(target));
    }
    NormalizedLink tip{.name = unique(used_links_, parent + "_foot", "_ball")};
    result_.source_links[tip.name] = leg.joints.back()->child;
    tip.joint = NormalizedJoint{.name = unique(used_joints_, tip.name + "_joint", "_ball"),
                                .parent = parent,
                                .T_parent_link = translation(foot.center_m)};
    tip.collisions.push_back({.shape = {.type = ShapeType::kSphere, .radius_m = foot.radius_m}});
    result_.links.push_back(std::move(tip));
  }
  const double mass_kg = total_mass_kg();  // with the masses that are assumed for links of the legs
  for (const LegJoint& each : leg_joints)
    result_.links[each.link].joint->motor = motor_of_leg(*each.joint, mass_kg, each.leg_m);
  assume("gait",
         fmt::format("walks with the gait of models/quadruped, scaled to {:.3g} kg and legs of {:.3g} m", mass_kg,
                     result_.leg_m),
         "locomotion in the settings file");
  constexpr double kMinTested_kg = 6.0, kMaxTested_kg = 60.0;  // models/README.md
  if (mass_kg >= kMinTested_kg && mass_kg <= kMaxTested_kg) return;
  assume("mass",
         fmt::format("{:.3g} kg are outside of the tested range of robots with legs, {:g} to {:g} kg: patrol check "
                     "shows whether it walks",
                     mass_kg, kMinTested_kg, kMaxTested_kg),
         "<mass> of the links");
}

JointRange Normalizer::range_of_leg(const SourceJoint& joint) {
  if (joint.type == JointType::kContinuous) {
    assume(joint.name, "is limited to a half turn to either side: the joint has no limits",
           "type revolute and <limit lower upper> of the joint");
    return {-std::numbers::pi, std::numbers::pi};
  }
  if (joint.lower >= joint.upper) {
    source_.fail(joint.line, joint.name,
                 fmt::format("limit lower = {}: must be below upper = {}", joint.lower, joint.upper));
  }
  return {joint.lower, joint.upper};
}

/// Replaces shapes that reach almost as far as the sphere of the foot: they would touch the ground beside it.
void Normalizer::keep_foot_free(const Foot& foot, const SourceJoint& knee, NormalizedLink& shank) {
  constexpr double kFree = 0.4;  // radii beyond the center of the foot
  const double reach_m = foot.center_m.norm() + kFree * foot.radius_m;
  const Eigen::Vector3d direction = foot.center_m.normalized();
  const std::size_t num_removed = std::erase_if(shank.collisions, [&](const NormalizedShape& part) {
    const double cap_m = part.shape.type == ShapeType::kCylinder ? part.shape.radius_m : 0.0;  // in the simulator
    const std::vector<Eigen::Vector3d> points = outline(part.shape);
    return std::any_of(points.begin(), points.end(),
                       [&](const Eigen::Vector3d& p) { return p.dot(direction) + cap_m > reach_m; });
  });
  if (num_removed == 0) return;
  shank.collisions.push_back({.shape = shank_of(foot)});
  assume(knee.child,
         "collision shapes that reach to the end of the foot are replaced by a cylinder that ends before it",
         "<collision> of the link");
}

/// Returns a cylinder from the knee to the foot that ends before the foot.
Shape Normalizer::shank_of(const Foot& foot) const {
  const double length_m = foot.center_m.norm();
  return {.type = ShapeType::kCylinder,
          .T_link_shape = {.position = 0.45 * foot.center_m, .rotation = along(foot.center_m.normalized())},
          .radius_m = 0.6 * foot.radius_m,
          .length_m = 0.7 * length_m};
}

/// Reports a center of mass that is far from the middle of the feet.
void Normalizer::check_legged_balance() {
  std::map<std::string, Pose3> T_base_new;
  std::vector<std::pair<Pose3, Inertial>> parts;
  double front_m = 0.0, side_m = 0.0;
  for (const NormalizedLink& link : result_.links) {
    T_base_new[link.name] = link.joint ? T_base_new.at(link.joint->parent) * link.joint->T_parent_link : Pose3{};
    if (link.inertial) parts.push_back({T_base_new.at(link.name), *link.inertial});
  }
  for (const FoundLeg& leg : legs_) {
    const Eigen::Vector3d hip = T_base(leg.joints.front()->child).position;
    front_m = std::max(front_m, hip.x());
    side_m = std::max(side_m, hip.y());
  }
  const Eigen::Vector2d center = combine(parts).T_link_inertia.position.head<2>();
  if (std::abs(center.x()) < 0.15 * front_m && std::abs(center.y()) < 0.15 * side_m + 0.01) return;
  assume("center of mass",
         fmt::format("is at x = {:.3f}, y = {:.3f} m from the middle of the legs: the trunk tilts", center.x(),
                     center.y()),
         "<inertial> of the links");
}

}  // namespace patrol::importer
