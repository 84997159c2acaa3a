#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/normalizer.h"

namespace patrol::importer {

/// Chooses the base: the root, without the massless links above the first one with mass, shapes or several children.
void Normalizer::choose_base() {
  for (const FoundWheel& wheel : found_.wheels) {
    kept_.insert(wheel.joint);
    if (wheel.carrier_type != CarrierType::kNone) kept_.insert(wheel.carrier);
  }
  const std::string root = source_.root().name;
  for (const SourceLink* link : rigid_group(source_, root, kept_)) chassis_.insert(link->name);
  base_ = options_.base_link;
  if (!base_.empty()) {
    if (!chassis_.contains(base_))
      source_.fail(source_.link(base_).line, base_, "moves against the body: the base link must be on the chassis");
    return;
  }
  base_ = root;
  while (true) {
    const SourceLink& link = source_.link(base_);
    const std::vector<const SourceJoint*> children = source_.child_joints(base_);
    const bool has_mass = link.inertial && link.inertial->mass_kg > 0.0;
    if (has_mass || children.size() != 1 || kept_.contains(children.front())) break;
    if (link.has_shapes()) {
      const SourceJoint& joint = *children.front();
      if (joint.type != JointType::kFloating || !source_.moves_whole_robot(joint)) break;
      chassis_.erase(base_);
      assume(base_,
             fmt::format("its visuals are left out: they mark the world above the floating joint {}", joint.name),
             "--base-link LINK");
    }
    base_ = children.front()->child;
  }
  result_.source_links["base_link"] = base_;
  // A massless root that carries sensors or casters beside the body is no base if one child carries all the wheels.
  if (base_ != "base_link") {
    assume("base_link", fmt::format("is the link {} of the file, renamed", base_), "--base-link LINK");
  }
}

/// Makes the frame of the base link level.
void Normalizer::level_base() {
  const Pose3 T_root_link = T_root_link_.at(base_);
  T_root_base_ = remove_tilt(T_root_link);
  const double tilt = std::acos(std::clamp((T_root_link.rotation * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  if (tilt < 1e-6) T_root_base_ = T_root_link;
  else
    assume("base_link", fmt::format("is leveled: {} is tilted by {:.1f} degrees", base_, tilt * kDegPerRad),
           "--base-link LINK");
}

/// Chooses the frame base_link: the frame of the base link, level, with the axles along y and between the wheels.
void Normalizer::choose_frame() {
  level_base();
  const std::map<std::string, double> yaws = {
      {"x", 0.0}, {"y", 0.5 * std::numbers::pi}, {"-x", std::numbers::pi}, {"-y", -0.5 * std::numbers::pi}};
  double yaw = 0.0;
  const auto axle = [this](const FoundWheel& wheel) {
    return axle_angle_rad(T_root_base_.rotation.conjugate() * wheel.axis);
  };
  const FoundWheel* first = nullptr;
  for (const FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    if (first == nullptr) first = &wheel;
    if (std::abs(std::remainder(axle(wheel) - axle(*first), std::numbers::pi)) > kParallel_rad) {
      source_.fail(
          wheel.joint->line, wheel.joint->name,
          fmt::format("axle is not parallel to that of {}: robots with omnidirectional wheels are not supported",
                      first->joint->name));
    }
  }
  if (first == nullptr) {
    const auto is_driven = [this](const SourceJoint& joint) {
      return source_.motors.contains(joint.name) || joint.effort.value_or(0.0) > 0.0;
    };
    const bool is_steered = std::all_of(found_.wheels.begin(), found_.wheels.end(), [&](const FoundWheel& wheel) {
      return is_driven(*wheel.joint) && is_driven(*wheel.carrier);
    });
    fail_for_wheels(found_.wheels.front().carrier, is_steered
                                                       ? all_steered(found_.wheels.size())
                                                       : "all wheels are casters: at least two wheels must not swivel");
  }
  if (!options_.forward.empty()) {
    yaw = yaws.at(options_.forward);
  } else if (std::abs(axle(*first)) > kParallel_rad) {
    yaw = axle(*first);
    if (std::abs(yaw - 0.5 * std::numbers::pi) < kParallel_rad) yaw = 0.5 * std::numbers::pi;
    assume("base_link",
           fmt::format(
               "is turned by {:.1f} degrees: the axles are along y, and the robot drives forward along {} of the file",
               yaw * kDegPerRad, yaw == 0.5 * std::numbers::pi ? "+y" : "this direction"),
           "--forward x, -x, y or -y");
  }
  if (yaw != 0.0) T_root_base_.rotation = T_root_base_.rotation * quaternion_from_yaw(yaw);
  if (std::abs(std::remainder(axle(*first), std::numbers::pi)) > kParallel_rad)
    source_.fail(first->joint->line, first->joint->name, "axle is along the forward direction: must be across");

  // Wheels in the base, with exact directions.
  const Pose3 T_base_root = T_root_base_.inverse();
  double min_y = std::numeric_limits<double>::infinity(), max_y = -min_y;
  for (const FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    const double y = (T_base_root * wheel.center_m).y();
    min_y = std::min(min_y, y);
    max_y = std::max(max_y, y);
  }
  const bool is_beside = min_y > 0.0 || max_y < 0.0;
  if (is_beside && max_y - min_y > 0.02) {
    T_root_base_.position = T_root_base_ * Eigen::Vector3d(0.0, 0.5 * (min_y + max_y), 0.0);
    assume("base_link", fmt::format("is moved by {:.3f} m along y to the middle of the wheels", 0.5 * (min_y + max_y)),
           "--base-link LINK");
  }
  const double below_m = (T_root_base_.inverse() * Eigen::Vector3d(0.0, 0.0, found_.ground_m)).z();
  if (below_m > 0.0) {
    T_root_base_.position = T_root_base_ * Eigen::Vector3d(0.0, 0.0, below_m);
    assume("base_link", fmt::format("is moved up by {:.3f} m: it was below the ground that the wheels touch", below_m),
           "--base-link LINK");
  }
  for (FoundWheel& wheel : found_.wheels) {
    wheel.center_m = T_root_base_.inverse() * wheel.center_m;
    wheel.axis = T_root_base_.rotation.conjugate() * wheel.axis;
  }
  ground_m_ = (T_root_base_.inverse() * Eigen::Vector3d(0.0, 0.0, found_.ground_m)).z();
}

}  // namespace patrol::importer
