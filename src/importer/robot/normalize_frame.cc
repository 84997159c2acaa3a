#include "importer/robot/normalize_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/robot/normalize_drive.h"

namespace patrol::importer {
namespace {

constexpr double kParallel_rad = 0.0447;  // 2.6 degrees, as io/urdf.cc

/// Returns the yaw of a direction of travel by option.
double yaw_of(const std::string& direction) {
  static const std::map<std::string, double> kYaws = {
      {"x", 0.0}, {"y", 0.5 * std::numbers::pi}, {"-x", std::numbers::pi}, {"-y", -0.5 * std::numbers::pi}};
  return kYaws.at(direction);
}

void turn_base(double yaw, RobotLayout& layout) {
  if (yaw != 0.0) layout.T_root_base.rotation = layout.T_root_base.rotation * quaternion_from_yaw(yaw);
}

/// Makes the frame of the base link level.
void level_base(RobotLayout& layout, std::vector<Assumption>& rows) {
  const Pose3 T_root_link = layout.T_root_link.at(layout.base);
  layout.T_root_base = remove_tilt(T_root_link);
  const double tilt = std::acos(std::clamp((T_root_link.rotation * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  if (tilt < 1e-6) layout.T_root_base = T_root_link;
  else
    rows.push_back({"base_link",
                    fmt::format("is leveled: {} is tilted by {:.1f} degrees", layout.base, tilt * kDegPerRad),
                    "--base-link LINK"});
}

/// Returns the angle of an axle that is still in the root, relative to y of the base.
double axle_in_base_rad(const RobotLayout& layout, const FoundWheel& wheel) {
  return axle_angle_rad(layout.T_root_base.rotation.conjugate() * wheel.axis);
}

/// Refuses a robot all of whose wheels are below vertical joints.
[[noreturn]] void fail_for_casters(const RobotLayout& layout) {
  const auto is_driven = [&layout](const SourceJoint& joint) {
    return layout.source.motors.contains(joint.name) || joint.effort.value_or(0.0) > 0.0;
  };
  const std::vector<FoundWheel>& wheels = layout.found.wheels;
  const bool is_steered = std::all_of(wheels.begin(), wheels.end(), [&](const FoundWheel& wheel) {
    return is_driven(*wheel.joint) && is_driven(*wheel.carrier);
  });
  fail_for_wheels(layout, wheels.front().carrier,
                  is_steered ? all_steered(wheels.size())
                             : "all wheels are casters: at least two wheels must not swivel");
}

/// Returns the first wheel that is not that of a caster, to which all other ones are parallel.
const FoundWheel& first_of_parallel(const RobotLayout& layout) {
  const FoundWheel* first = nullptr;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    if (first == nullptr) first = &wheel;
    const double turned_rad = axle_in_base_rad(layout, wheel) - axle_in_base_rad(layout, *first);
    if (std::abs(std::remainder(turned_rad, std::numbers::pi)) <= kParallel_rad) continue;
    layout.source.fail(
        wheel.joint->line, wheel.joint->name,
        fmt::format("axle is not parallel to that of {}: robots with omnidirectional wheels are not supported",
                    first->joint->name));
  }
  if (first == nullptr) fail_for_casters(layout);
  return *first;
}

/// Turns the base by option or until an axle is along y.
void turn_to_axle(RobotLayout& layout, const FoundWheel& wheel, const std::string& forward,
                  std::vector<Assumption>& rows) {
  double yaw = forward.empty() ? 0.0 : yaw_of(forward);
  if (forward.empty() && std::abs(axle_in_base_rad(layout, wheel)) > kParallel_rad) {
    yaw = axle_in_base_rad(layout, wheel);
    if (std::abs(yaw - 0.5 * std::numbers::pi) < kParallel_rad) yaw = 0.5 * std::numbers::pi;
    rows.push_back(
        {"base_link",
         fmt::format(
             "is turned by {:.1f} degrees: the axles are along y, and the robot drives forward along {} of the file",
             yaw * kDegPerRad, yaw == 0.5 * std::numbers::pi ? "+y" : "this direction"),
         "--forward x, -x, y or -y"});
  }
  turn_base(yaw, layout);
  if (std::abs(std::remainder(axle_in_base_rad(layout, wheel), std::numbers::pi)) > kParallel_rad)
    layout.source.fail(wheel.joint->line, wheel.joint->name, "axle is along the forward direction: must be across");
}

/// Moves a base that is beside all wheels to the middle between them.
void center_base(RobotLayout& layout, std::vector<Assumption>& rows) {
  const Pose3 T_base_root = layout.T_root_base.inverse();
  double min_y = std::numeric_limits<double>::infinity(), max_y = -min_y;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    const double y = (T_base_root * wheel.center_m).y();
    min_y = std::min(min_y, y);
    max_y = std::max(max_y, y);
  }
  const bool is_beside = min_y > 0.0 || max_y < 0.0;
  if (!is_beside || max_y - min_y <= 0.02) return;
  layout.T_root_base.position = layout.T_root_base * Eigen::Vector3d(0.0, 0.5 * (min_y + max_y), 0.0);
  rows.push_back({"base_link",
                  fmt::format("is moved by {:.3f} m along y to the middle of the wheels", 0.5 * (min_y + max_y)),
                  "--base-link LINK"});
}

/// Returns the height of the ground in the base.
double ground_in_base_m(const RobotLayout& layout) {
  return (layout.T_root_base.inverse() * Eigen::Vector3d(0.0, 0.0, layout.found.ground_m)).z();
}

/// Moves a base that is below the ground up to it.
void raise_base(RobotLayout& layout, std::vector<Assumption>& rows) {
  const double below_m = ground_in_base_m(layout);
  if (below_m <= 0.0) return;
  layout.T_root_base.position = layout.T_root_base * Eigen::Vector3d(0.0, 0.0, below_m);
  rows.push_back({"base_link",
                  fmt::format("is moved up by {:.3f} m: it was below the ground that the wheels touch", below_m),
                  "--base-link LINK"});
}

/// Moves the wheels from the root to the base.
void move_wheels_to_base(RobotLayout& layout) {
  for (FoundWheel& wheel : layout.found.wheels) {
    wheel.center_m = layout.T_root_base.inverse() * wheel.center_m;
    wheel.axis = layout.T_root_base.rotation.conjugate() * wheel.axis;
  }
}

/// Refuses a robot whose first joints of the legs are above each other rather than beside each other.
void check_hips(const RobotLayout& layout) {
  Eigen::AlignedBox3d box;
  for (const FoundLeg& leg : layout.legs) box.extend(layout.T_base(leg.joints.front()->child).position);
  const Eigen::Vector3d size = box.sizes();
  if (size.z() <= std::min(size.x(), size.y())) return;
  const SourceJoint& joint = *layout.legs.front().joints.front();
  layout.source.fail(
      joint.line, joint.name,
      fmt::format("the first joints of the legs are {:.2f} m apart in height, but only {:.2f} m to the side: z "
                  "of {} must be up: add a root link with a fixed joint that turns the robot",
                  size.z(), std::min(size.x(), size.y()), layout.base));
}

}  // namespace

void choose_base(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows) {
  for (const FoundWheel& wheel : layout.found.wheels) {
    layout.kept.insert(wheel.joint);
    if (wheel.carrier_type != CarrierType::kNone) layout.kept.insert(wheel.carrier);
  }
  const std::string root = layout.source.root().name;
  for (const SourceLink* link : rigid_group(layout.source, root, layout.kept)) layout.chassis.insert(link->name);
  layout.base = options.base_link;
  if (!layout.base.empty()) {
    if (!layout.chassis.contains(layout.base))
      layout.source.fail(layout.source.link(layout.base).line, layout.base,
                         "moves against the body: the base link must be on the chassis");
    return;
  }
  layout.base = root;
  while (true) {
    const SourceLink& link = layout.source.link(layout.base);
    const std::vector<const SourceJoint*> children = layout.source.child_joints(layout.base);
    const bool has_mass = link.inertial && link.inertial->mass_kg > 0.0;
    if (has_mass || children.size() != 1 || layout.kept.contains(children.front())) break;
    if (link.has_shapes()) {
      const SourceJoint& joint = *children.front();
      if (joint.type != JointType::kFloating || !layout.source.moves_whole_robot(joint)) break;
      layout.chassis.erase(layout.base);
      rows.push_back(
          {layout.base,
           fmt::format("its visuals are left out: they mark the world above the floating joint {}", joint.name),
           "--base-link LINK"});
    }
    layout.base = children.front()->child;
  }
  // A massless root that carries sensors or casters beside the body is no base if one child carries all the wheels.
  if (layout.base != "base_link") {
    rows.push_back({"base_link", fmt::format("is the link {} of the file, renamed", layout.base), "--base-link LINK"});
  }
}

void choose_wheeled_frame(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows) {
  level_base(layout, rows);
  turn_to_axle(layout, first_of_parallel(layout), options.forward, rows);
  center_base(layout, rows);
  raise_base(layout, rows);
  move_wheels_to_base(layout);
  layout.ground_m = ground_in_base_m(layout);
}

void choose_legged_frame(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows) {
  level_base(layout, rows);
  const SourceJoint& knee = *layout.legs.front().joints.back();
  const Eigen::Vector3d knee_axis =
      layout.T_root_base.rotation.conjugate() * (layout.T_root_link.at(knee.child).rotation * knee.axis);
  double yaw = 0.0;
  if (!options.forward.empty()) {
    yaw = yaw_of(options.forward);
  } else if (std::abs(knee_axis.x()) > std::abs(knee_axis.y())) {
    yaw = 0.5 * std::numbers::pi;
    rows.push_back({"base_link",
                    "is turned by 90 degrees: the knees turn about y, and the robot walks forward along +y of the file",
                    "--forward x, -x, y or -y"});
  }
  turn_base(yaw, layout);

  check_hips(layout);
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  for (const FoundLeg& leg : layout.legs)
    center += layout.T_base(leg.joints.front()->child).position / static_cast<double>(layout.legs.size());
  constexpr double kCentered_m = 0.02;
  if (center.norm() > kCentered_m) {
    layout.T_root_base.position = layout.T_root_base * center;
    rows.push_back({"base_link",
                    fmt::format("is moved by {:.3f}, {:.3f}, {:.3f} m to the middle of the first joints of the legs",
                                center.x(), center.y(), center.z()),
                    "--base-link LINK"});
  }
}

}  // namespace patrol::importer
