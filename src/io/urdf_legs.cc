#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/frames.h"
#include "core/geometry/convex_polygon.h"
#include "core/gravity.h"
#include "core/leg_kinematics.h"
#include "io/urdf_reader.h"

namespace patrol::io {
namespace {

constexpr std::size_t kNumLegs = 4;
constexpr std::size_t kJointsPerLeg = 3;

bool is_movable(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

/// Returns the movable joints from the root to a link, from the root on.
std::vector<urdf::JointConstSharedPtr> movable_joints_above(const urdf::Link& link) {
  std::vector<urdf::JointConstSharedPtr> joints;
  urdf::JointConstSharedPtr at = link.parent_joint;
  for (urdf::LinkConstSharedPtr parent = link.getParent(); at; parent = parent->getParent()) {
    if (is_movable(*at)) joints.insert(joints.begin(), at);
    if (!parent) break;
    at = parent->parent_joint;
  }
  return joints;
}

bool has_movable_joint_below(const urdf::Link& link) {
  return std::any_of(link.child_links.begin(), link.child_links.end(), [](const urdf::LinkSharedPtr& child) {
    return is_movable(*child->parent_joint) || has_movable_joint_below(*child);
  });
}

/// Returns the pose of a link of a rigid group in the frame of the group's first link.
Pose3 T_first_link(const urdf::Link& first, const urdf::Link& link) {
  if (link.name == first.name) return {};
  return T_first_link(first, *link.getParent()) * to_pose(link.parent_joint->parent_to_joint_origin_transform);
}

/// Appends a link and the links fixed to it.
void add_rigid_group(const urdf::LinkConstSharedPtr& link, std::vector<urdf::LinkConstSharedPtr>& group) {
  group.push_back(link);
  for (const urdf::LinkSharedPtr& child : link->child_links) {
    if (!is_movable(*child->parent_joint)) add_rigid_group(child, group);
  }
}

Eigen::Vector3d unit_axis(const urdf::Joint& joint) {
  return Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).stableNormalized();
}

/// Returns whether the joints of a leg are abduction about x, hip and knee about y, in frames that are parallel at
/// zero, and the leg then hangs straight down.
bool is_straight_leg(const LegChain& chain) {
  const auto has_axis = [](const LegJoint& joint, const Eigen::Vector3d& axis) {
    return joint.T_parent_joint.rotation.vec().isZero(0.0) && (joint.axis - axis).isZero(0.0);
  };
  const Eigen::Vector3d hip = chain.joints[1].T_parent_joint.position, knee = chain.joints[2].T_parent_joint.position;
  return has_axis(chain.joints[0], Eigen::Vector3d::UnitX()) && has_axis(chain.joints[1], Eigen::Vector3d::UnitY()) &&
         has_axis(chain.joints[2], Eigen::Vector3d::UnitY()) && hip.x() == 0.0 && hip.z() == 0.0 &&
         knee.head<2>().isZero(0.0) && knee.z() < 0.0 && chain.foot.head<2>().isZero(0.0) && chain.foot.z() < 0.0;
}

/// Returns the angle of a part of a leg from the vertical in the xz plane, positive backward.
double angle_from_vertical_rad(const Eigen::Vector3d& part) { return std::atan2(-part.x(), -part.z()); }

double length_xz(const Eigen::Vector3d& v) { return std::hypot(v.x(), v.z()); }

/// Returns the angle within the limits that is equal modulo a turn and nearest to zero; nullopt if there is none.
std::optional<double> angle_within(double angle_rad, const JointLimit& limit) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  const double nearest = std::remainder(angle_rad, kTurn_rad);
  for (const double turns : {0.0, -1.0, 1.0}) {
    const double angle = nearest + turns * kTurn_rad;
    if (angle >= limit.lower_rad && angle <= limit.upper_rad) return angle;
  }
  return std::nullopt;
}

/// Rounds joint angles to 0.001 rad: a posture does not depend on the last digits of the lengths.
Eigen::Vector3d rounded(const Eigen::Vector3d& joint_rad) { return (joint_rad * 1000.0).array().round() / 1000.0; }

}  // namespace

/// Returns the links behind the third of three movable joints in a row, without further movable joints below.
std::vector<urdf::LinkConstSharedPtr> UrdfReader::leg_ends() const {
  std::vector<urdf::LinkConstSharedPtr> ends;
  for (const auto& [name, link] : model_->links_) {
    if (!link->parent_joint || !is_movable(*link->parent_joint) || has_movable_joint_below(*link)) continue;
    const std::vector<urdf::JointConstSharedPtr> joints = movable_joints_above(*link);
    const bool are_revolute = std::all_of(joints.begin(), joints.end(), [](const urdf::JointConstSharedPtr& each) {
      return each->type == urdf::Joint::REVOLUTE;
    });
    if (joints.size() == kJointsPerLeg && are_revolute) ends.push_back(link);
  }
  return ends;
}

bool UrdfReader::has_legs() const { return leg_ends().size() == kNumLegs; }

/// Reads the chain of a leg. Its foot is the sphere with the largest distance from the knee.
LegGeometry UrdfReader::read_chain(const urdf::LinkConstSharedPtr& end) const {
  LegGeometry leg;
  leg.chain.emplace();
  const std::vector<urdf::JointConstSharedPtr> joints = movable_joints_above(*end);
  Pose3 T_body_parent;
  for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
    const Pose3 T_body_joint = T_body_link(*model_->getLink(joints[i]->child_link_name));
    leg.chain->joints[i] = {.T_parent_joint = T_body_parent.inverse() * T_body_joint, .axis = unit_axis(*joints[i])};
    T_body_parent = T_body_joint;
  }
  std::vector<urdf::LinkConstSharedPtr> group;
  add_rigid_group(end, group);
  double reach_m = -1.0;
  for (const urdf::LinkConstSharedPtr& link : group) {
    if (link->collision_array.size() != 1) continue;
    const urdf::Collision& shape = *link->collision_array.front();
    if (shape.geometry->type != urdf::Geometry::SPHERE) continue;
    const Eigen::Vector3d center = T_first_link(*end, *link) * to_pose(shape.origin).position;
    if (center.norm() <= reach_m) continue;
    reach_m = center.norm();
    leg.chain->foot = center;
    leg.foot_link = link->name;
    leg.foot_radius_m = dynamic_cast<const urdf::Sphere&>(*shape.geometry).radius;
  }
  if (leg.foot_link.empty()) {
    fail(end->name,
         "no foot: this link, or one fixed to it, must have a sphere as its only collision shape (patrol import robot "
         "adds one)");
  }
  return leg;
}

/// Computes the standing posture: the leg in a vertical plane along x, the foot below the hip, and the lengths of the
/// leg in this posture. The knee bends to the side to which it is bent at zero angles, and backward if it is straight
/// there, as far as the limits allow.
void UrdfReader::choose_standing(const std::array<JointLimit, 3>& limits, double mass_kg, LegGeometry& leg) const {
  // Height of the hip above the foot by the length of the leg: thigh and shank of equal length are at 0.8 rad.
  const double nominal_ratio = std::cos(0.8);
  constexpr double kStep = 0.02, kMaxRatio = 0.95;
  constexpr double kMaxTorqueFraction = 0.6;  // of the knee's motor, with the weight on two feet

  const LegChainState zero = chain_state(*leg.chain, Eigen::Vector3d::Zero());
  const std::size_t abduction = std::abs(zero.axis[0].x()) >= std::abs(zero.axis[0].y()) ? 0 : 1;
  const std::size_t hip = 1 - abduction, knee = 2;
  // The abduction turns the axis of the knee across the robot.
  const Eigen::Vector3d roll_axis = zero.axis[abduction];
  const Eigen::Vector3d across = zero.axis[knee] - zero.axis[knee].dot(roll_axis) * roll_axis;
  double roll_rad = std::atan2(roll_axis.dot(across.cross(Eigen::Vector3d::UnitY())), across.y());
  if (std::abs(roll_rad) > 0.5 * std::numbers::pi) roll_rad -= std::copysign(std::numbers::pi, roll_rad);
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();
  angles[static_cast<Eigen::Index>(abduction)] = roll_rad;
  const LegChainState start = chain_state(*leg.chain, angles);
  constexpr double kParallel = 0.966, kPerpendicular = 0.259;  // 15 degrees
  const bool is_roll = abduction == 0 ? std::abs(roll_axis.x()) > kParallel : std::abs(roll_axis.y()) < kPerpendicular;
  const bool is_supported =
      is_roll && std::abs(start.axis[hip].y()) > kParallel && std::abs(start.axis[knee].y()) > kParallel;
  if (!is_supported) {
    fail(leg.foot_link, fmt::format("the joints of a leg must be one about x and one about y of {}, in either order, "
                                    "and a knee about y",
                                    frame_id::kBody));
  }
  const Eigen::Vector3d thigh = start.position[knee] - start.position[hip], shank = start.foot - start.position[knee];
  leg.thigh_m = length_xz(thigh);
  leg.shank_m = length_xz(shank);
  constexpr double kMinLength_m = 0.02;
  if (leg.thigh_m < kMinLength_m || leg.shank_m < kMinLength_m)
    fail(leg.foot_link, "the axes of hip and knee and the foot must be at least 0.02 m apart");

  std::optional<double> roll = angle_within(roll_rad, limits[abduction]);
  const double hip_sign = start.axis[hip].y() > 0.0 ? 1.0 : -1.0, knee_sign = start.axis[knee].y() > 0.0 ? 1.0 : -1.0;
  const double hip_rad = angle_from_vertical_rad(thigh), knee_rad = angle_from_vertical_rad(shank) - hip_rad;
  constexpr double kBent_rad = 0.1;
  const bool is_forward_at_zero = knee_rad > kBent_rad;
  bool has_posture = false;
  for (double ratio = nominal_ratio; roll && ratio < kMaxRatio; ratio += kStep) {
    const double height_m = ratio * leg.length_m();
    for (const bool is_backward : {!is_forward_at_zero, is_forward_at_zero}) {
      const auto planar = planar_leg_angles(leg.thigh_m, leg.shank_m, 0.0, -height_m, is_backward);
      if (!planar) continue;
      const auto hip_angle = angle_within(hip_sign * (planar->hip_rad - hip_rad), limits[hip]);
      const auto knee_angle = angle_within(knee_sign * (planar->knee_rad - knee_rad), limits[knee]);
      if (!hip_angle || !knee_angle) continue;
      angles[static_cast<Eigen::Index>(abduction)] = *roll;
      angles[static_cast<Eigen::Index>(hip)] = *hip_angle;
      angles[static_cast<Eigen::Index>(knee)] = *knee_angle;
      has_posture = true;
      break;
    }
    if (!has_posture) continue;
    const LegChainState standing = chain_state(*leg.chain, angles);
    const double lever_m = std::abs(standing.position[knee].x() - standing.foot.x());
    if (0.5 * mass_kg * kGravity_mps2 * lever_m <= kMaxTorqueFraction * limits[knee].effort_nm) break;
  }
  if (!has_posture) fail(leg.foot_link, "the limits of the joints allow no posture with the foot below the hip");
  leg.standing_rad = rounded(angles);
  const LegChainState standing = chain_state(*leg.chain, leg.standing_rad);
  leg.hip_in_body = {standing.foot.x(), standing.position[0].y(), standing.position[0].z()};
  leg.abduction_offset_m = standing.foot.y() - standing.position[0].y();
}

/// Reads four legs. Names do not matter: the position of the first joint says which leg it is.
void UrdfReader::read_legs(RobotDescription& robot) const {
  const std::vector<urdf::LinkConstSharedPtr> ends = leg_ends();
  if (ends.size() != kNumLegs) {
    throw InputError(
        fmt::format("{}: no drive: neither wheels on continuous joints, nor tracks, nor four legs with three revolute "
                    "joints each ({} found)",
                    path_, ends.size()));
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  const auto first_joint = [](const urdf::LinkConstSharedPtr& end) { return movable_joints_above(*end).front(); };
  const auto hip_position = [&](const urdf::LinkConstSharedPtr& end) {
    return T_body_link(*model_->getLink(first_joint(end)->child_link_name)).position;
  };
  for (const urdf::LinkConstSharedPtr& end : ends) center += hip_position(end) / kNumLegs;
  constexpr std::array kLegNames = {"FL", "FR", "RL", "RR"};
  std::array<urdf::LinkConstSharedPtr, kNumLegs> corners;
  for (const urdf::LinkConstSharedPtr& end : ends) {
    const Eigen::Vector3d offset = hip_position(end) - center;
    urdf::LinkConstSharedPtr& corner = corners[(offset.x() > 0.0 ? 0 : 2) + (offset.y() > 0.0 ? 0 : 1)];
    if (corner)
      fail(end->name,
           fmt::format("is at the same corner of the robot as {}: a leg must be at each corner", corner->name));
    corner = end;
  }
  for (std::size_t i = 0; i < kNumLegs; ++i) {
    std::array<JointLimit, 3> limits;
    const std::vector<urdf::JointConstSharedPtr> joints = movable_joints_above(*corners[i]);
    for (std::size_t k = 0; k < kJointsPerLeg; ++k) limits[k] = robot.joint_limits[add_joint(joints[k]->name, robot)];
    LegGeometry leg = read_chain(corners[i]);
    leg.name = kLegNames[i];
    choose_standing(limits, robot.mass_kg, leg);
    if (is_straight_leg(*leg.chain)) {
      leg.hip_in_body = leg.chain->joints[0].T_parent_joint.position;
      leg.abduction_offset_m = leg.chain->joints[1].T_parent_joint.position.y();
      leg.thigh_m = -leg.chain->joints[2].T_parent_joint.position.z();
      leg.shank_m = -leg.chain->foot.z();
      leg.chain.reset();
    }
    robot.legs.push_back(std::move(leg));
  }
  check_joints(robot);
}

/// Rejects movable joints that nothing drives.
void UrdfReader::check_joints(const RobotDescription& robot) const {
  for (const auto& [name, joint] : model_->joints_) {
    const bool is_known =
        std::find(robot.joint_names.begin(), robot.joint_names.end(), name) != robot.joint_names.end();
    if (!is_movable(*joint) || is_known || name.starts_with("tem_")) continue;
    fail(name, "is not a joint of a leg: must be fixed (patrol import robot does this)");
  }
}

/// Returns the pose of a link in body with the legs in their standing posture.
Pose3 UrdfReader::T_body_standing(const urdf::Link& link, const RobotDescription& robot) const {
  if (link.name == frame_id::kBody) return {};
  Pose3 T_parent_link = to_pose(link.parent_joint->parent_to_joint_origin_transform);
  const auto joint = std::find(robot.joint_names.begin(), robot.joint_names.end(), link.parent_joint->name);
  if (joint != robot.joint_names.end()) {
    const auto index = static_cast<std::size_t>(joint - robot.joint_names.begin());
    const double angle =
        robot.legs[index / kJointsPerLeg].standing_rad[static_cast<Eigen::Index>(index % kJointsPerLeg)];
    T_parent_link.rotation = T_parent_link.rotation * Eigen::AngleAxisd(angle, unit_axis(*link.parent_joint));
  }
  return T_body_standing(*link.getParent(), robot) * T_parent_link;
}

/// Computes the center of mass of the standing robot and the moments of inertia about it.
void UrdfReader::read_standing_inertia(RobotDescription& robot) const {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the origin of body
  const auto point_inertia = [](double mass, const Eigen::Vector3d& p) -> Eigen::Matrix3d {
    return mass * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
  };
  for (const auto& [name, link] : model_->links_) {
    if (!link->inertial) continue;
    const urdf::Inertial& part = *link->inertial;
    const Pose3 T_body_part = T_body_standing(*link, robot) * to_pose(part.origin);
    Eigen::Matrix3d own;
    own << part.ixx, part.ixy, part.ixz, part.ixy, part.iyy, part.iyz, part.ixz, part.iyz, part.izz;
    const Eigen::Matrix3d R = T_body_part.rotation.toRotationMatrix();
    inertia += R * own * R.transpose() + point_inertia(part.mass, T_body_part.position);
    center += part.mass / robot.mass_kg * T_body_part.position;
  }
  robot.standing_center_m = center;
  robot.standing_inertia_kgm2 = (inertia - point_inertia(robot.mass_kg, center)).diagonal();
}

/// Returns the footprint of the standing robot: the shapes of base_link and the feet, and any other part on the body
/// that stands out by more than 1 cm. Thighs and shanks do not count.
std::vector<Eigen::Vector2d> UrdfReader::read_legged_footprint(const RobotDescription& robot) const {
  constexpr double kNegligible_m = 0.01;
  std::vector<Eigen::Vector2d> points;
  add_outline(*model_->getLink(frame_id::kBody), {}, points);
  for (const LegGeometry& leg : robot.legs) {
    const Eigen::Vector3d foot = foot_position(leg, leg.standing_rad);
    for (int corner = 0; corner < 8; ++corner) {
      const double angle = corner * std::numbers::pi / 4.0;
      points.emplace_back(foot.head<2>() + leg.foot_radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  }
  ConvexPolygon footprint = convex_hull(points);
  const auto distance_outside_m = [&footprint](const Eigen::Vector2d& p) {
    double distance_m = 0.0;
    for (std::size_t i = 0; i < footprint.size(); ++i) {
      const Eigen::Vector2d side = (footprint[(i + 1) % footprint.size()] - footprint[i]).normalized(),
                            to = p - footprint[i];
      distance_m = std::max(distance_m, to.x() * side.y() - to.y() * side.x());
    }
    return distance_m;
  };
  for (const auto& [name, link] : model_->links_) {
    if (!movable_joints_above(*link).empty()) continue;
    std::vector<Eigen::Vector2d> others;
    add_outline(*link, T_body_standing(*link, robot), others);
    const bool stands_out = std::any_of(
        others.begin(), others.end(), [&](const Eigen::Vector2d& p) { return distance_outside_m(p) > kNegligible_m; });
    if (!stands_out) continue;
    others.insert(others.end(), footprint.begin(), footprint.end());
    footprint = convex_hull(std::move(others));
  }
  return footprint;
}

}  // namespace patrol::io
