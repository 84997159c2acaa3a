#include "importer/robot/normalize_drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::importer {
namespace {

/// Refuses a caster whose wheels are far apart: it is the axle of a trailer or a wagon. Both wheels of a caster are
/// close together.
void check_caster(const RobotLayout& layout, const FoundWheel& wheel) {
  constexpr double kMinAxle = 3.0;  // to the radius
  for (const FoundWheel& other : layout.found.wheels) {
    if (other.carrier != wheel.carrier || (other.center_m - wheel.center_m).norm() < kMinAxle * wheel.radius_m)
      continue;
    layout.source.fail(
        wheel.carrier->line, wheel.carrier->name,
        "swivels with a whole axle: trailers, articulated robots and turntable steering are not supported");
  }
}

/// Checks the joint that steers a wheel: it must not steer a whole axle.
void check_steered_wheel(const RobotLayout& layout, const FoundWheel& wheel) {
  for (const FoundWheel& other : layout.found.wheels) {
    if (other.carrier != wheel.carrier || (other.center_m - wheel.center_m).norm() < 1.5 * wheel.radius_m) continue;
    layout.source.fail(wheel.carrier->line, wheel.carrier->name,
                       "steers a whole axle: articulated robots and turntable steering are not supported");
  }
}

/// Decides about endless joints with motors above wheels, and about steering that the option removes.
void choose_carriers(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows) {
  std::size_t num_steered = 0;
  for (FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) check_caster(layout, wheel);
    if (wheel.carrier_type != CarrierType::kSteering) continue;
    if (options.drive == "differential") {
      rows.push_back(
          {wheel.carrier->name, "steering is fixed straight ahead: the drive is differential", "--drive ackermann"});
      layout.kept.erase(wheel.carrier);
      wheel.carrier_type = CarrierType::kNone;
      continue;
    }
    ++num_steered;
    check_steered_wheel(layout, wheel);
  }
  if (num_steered > 0 && num_steered == layout.found.wheels.size()) {
    const SourceJoint& joint = *layout.found.wheels.front().carrier;
    layout.source.fail(joint.line, joint.name, all_steered(num_steered));
  }
  if (options.drive == "ackermann" && num_steered == 0) {
    throw InputError(
        fmt::format("{}: drive ackermann: no wheel is below a revolute joint about the vertical", layout.source.file));
  }
  const bool has_rollers = std::any_of(layout.found.wheels.begin(), layout.found.wheels.end(),
                                       [](const FoundWheel& wheel) { return wheel.num_rollers > 0; });
  if (has_rollers && options.drive != "" && options.drive != "mecanum")
    throw InputError(
        fmt::format("{}: drive {}: the wheels have rollers: must be mecanum", layout.source.file, options.drive));
  layout.drive = has_rollers || options.drive == "mecanum" ? DriveType::kMecanum
                 : num_steered > 0                         ? DriveType::kAckermann
                                                           : DriveType::kDifferential;
}

using Wheels = std::vector<const FoundWheel*>;

/// Returns the wheels that motors drive by the file: those named by it, otherwise those with limits; without any, all
/// that are not steered.
Wheels motorized_wheels(const RobotLayout& layout, std::vector<Assumption>& rows) {
  Wheels named, limited, unsteered;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    if (layout.source.motors.contains(wheel.joint->name)) named.push_back(&wheel);
    if (wheel.joint->effort.value_or(0.0) > 0.0 && wheel.joint->velocity.value_or(0.0) > 0.0) limited.push_back(&wheel);
    if (wheel.carrier_type == CarrierType::kNone) unsteered.push_back(&wheel);
  }
  if (!named.empty()) return named;
  if (!limited.empty()) return limited;
  std::vector<std::string> names;
  for (const FoundWheel* wheel : unsteered) names.push_back(wheel->joint->name);
  rows.push_back({"drive", fmt::format("motors drive {}: the file names no motors", list_of(names)),
                  "<limit effort velocity> of the driven wheels' joints, or <transmission>"});
  return unsteered;
}

/// Drives the wheels whose <mimic> follows a driven wheel or another joint with a motor.
void drive_mimics(RobotLayout& layout, std::vector<Assumption>& rows) {
  const SourceRobot& source = layout.source;
  const auto has_motor = [&](const SourceJoint& joint) {
    return layout.driven.contains(&joint) || source.motors.contains(joint.name) || joint.effort.value_or(0.0) > 0.0;
  };
  const std::set<const SourceJoint*> driven_alone = layout.driven;
  for (const FoundWheel& wheel : layout.found.wheels) {
    const SourceJoint& joint = *wheel.joint;
    if (wheel.carrier_type == CarrierType::kCaster || !joint.is_mimic) continue;
    const SourceJoint* at = source.find_joint(joint.mimicked);
    while (at->is_mimic && !has_motor(*at)) at = source.find_joint(at->mimicked);
    if (has_motor(*at)) {
      layout.driven.insert(&joint);
      const bool is_wheel = driven_alone.contains(at);
      rows.push_back(
          {joint.name,
           fmt::format("has a motor: its <mimic> follows {}{}", is_wheel ? "a driven wheel, " : "the motor ", at->name),
           "<mimic> of the joint"});
    } else if (!layout.driven.contains(&joint)) {
      rows.push_back({joint.name, fmt::format("has no motor: its <mimic> follows {}, which has none", at->name),
                      "<mimic> of the joint"});
    }
  }
}

/// Checks that motors drive wheels on both sides.
void check_driven_sides(const RobotLayout& layout) {
  double min_y = std::numeric_limits<double>::infinity(), max_y = -min_y;
  for (const FoundWheel& wheel : layout.found.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster || !layout.driven.contains(wheel.joint)) continue;
    min_y = std::min(min_y, wheel.center_m.y());
    max_y = std::max(max_y, wheel.center_m.y());
  }
  if (min_y <= 0.0 && max_y >= 0.0 && max_y - min_y >= 1e-3) return;
  constexpr double kMiddle_m = 0.01;
  const bool is_in_middle = std::max(std::abs(min_y), std::abs(max_y)) < kMiddle_m;
  fail_for_wheels(layout, *layout.driven.begin(),
                  is_in_middle ? "the driven wheel is in the middle: not supported: wheels on both sides must be "
                                 "driven, each on a joint of its own"
                               : "driven wheels on one side only: both sides must be driven");
}

/// Checks that wheels that are not steered are on both sides; if motors drive any of these, that driven ones are.
void check_fixed_sides(const RobotLayout& layout) {
  const auto is_fixed = [](const FoundWheel& wheel) { return wheel.carrier_type == CarrierType::kNone; };
  const auto is_driven = [&layout](const FoundWheel& wheel) { return layout.driven.contains(wheel.joint); };
  const std::vector<FoundWheel>& wheels = layout.found.wheels;
  const bool is_any_driven =
      std::ranges::any_of(wheels, [&](const FoundWheel& wheel) { return is_fixed(wheel) && is_driven(wheel); });
  const FoundWheel* left = nullptr;
  const FoundWheel* right = nullptr;
  for (const FoundWheel& wheel : wheels) {
    if (is_fixed(wheel) && (!is_any_driven || is_driven(wheel))) (wheel.center_m.y() > 0.0 ? left : right) = &wheel;
  }
  if (left != nullptr && right != nullptr) return;
  const auto first =
      std::ranges::find_if(wheels, [](const FoundWheel& wheel) { return wheel.carrier_type != CarrierType::kCaster; });
  const SourceJoint* at = left != nullptr ? left->joint : right != nullptr ? right->joint : first->joint;
  fail_for_wheels(layout, at,
                  left == nullptr && right == nullptr
                      ? "all wheels but casters are steered: not supported: both sides must have one that is not"
                      : "wheels that are not steered are on one side only: both sides must have one");
}

/// Rollers of all wheels of a mecanum drive.
struct RollerCount {
  int num_x = 0, num_o = 0;  ///< wheels whose upper rollers are along an X or an O, seen from above
  double sum_rad = 0.0;      ///< sum of the angles of the rollers to the axle
};

/// Checks that a mecanum drive has a driven wheel at each corner that does not swivel, and counts their rollers.
RollerCount count_rollers(const RobotLayout& layout, double middle_x_m) {
  RollerCount count;
  std::set<std::pair<bool, bool>> corners;
  for (const FoundWheel& wheel : layout.found.wheels) {
    const SourceJoint& joint = *wheel.joint;
    const auto fail = [&](const std::string& what) { layout.source.fail(joint.line, joint.name, what); };
    if (wheel.carrier_type != CarrierType::kNone)
      fail("is below a vertical joint: a wheel of a mecanum drive must not swivel");
    if (!layout.driven.contains(&joint)) fail("has no motor: all wheels of a mecanum drive must be driven");
    const bool is_front = wheel.center_m.x() > middle_x_m, is_left = wheel.center_m.y() > 0.0;
    if (!corners.insert({is_front, is_left}).second)
      fail("each side of a mecanum drive must have a front and a rear wheel");
    if (wheel.num_rollers == 0) continue;
    ++((wheel.roller_axis_rad < 0.0) == (is_front == is_left) ? count.num_x : count.num_o);
    count.sum_rad += 0.5 * std::numbers::pi - std::abs(wheel.roller_axis_rad);
  }
  return count;
}

/// Checks that the rollers of all wheels form one pattern, and that this pattern turns the robot.
void check_pattern(const RobotLayout& layout, const RollerCount& count, double middle_x_m) {
  if (count.num_x != 4 && count.num_o != 4) {
    const SourceJoint& joint = *layout.found.wheels.front().joint;
    layout.source.fail(
        joint.line, joint.name,
        fmt::format("rollers of {} wheels form an X seen from above, those of {} an O: must be four of a kind",
                    count.num_x, count.num_o));
  }
  if (count.num_x == 4) return;
  for (const FoundWheel& wheel : layout.found.wheels) {
    const double x_m = std::abs(wheel.center_m.x() - middle_x_m), y_m = std::abs(wheel.center_m.y());
    const double reach_m = x_m * std::tan(std::abs(wheel.roller_axis_rad));
    if (std::abs(reach_m - y_m) > 0.1 * (reach_m + y_m)) continue;
    layout.source.fail(wheel.joint->line, wheel.joint->name,
                       "rollers on the ground point at the middle of the robot: the wheels do not turn it");
  }
}

}  // namespace

std::string all_steered(std::size_t num_wheels) {
  return fmt::format("all {} wheels are steered: not supported: fix the steering joints of one axle", num_wheels);
}

void fail_for_wheels(const RobotLayout& layout, const SourceJoint* joint, const std::string& what) {
  for (const RejectedWheel& rejected : layout.found.rejected) {
    const SourceJoint& at = *rejected.joint;
    if (std::any_of(layout.found.wheels.begin(), layout.found.wheels.end(),
                    [&at](const FoundWheel& wheel) { return wheel.carrier == &at; }))
      continue;
    if (!layout.source.motors.contains(at.name) && at.effort.value_or(0.0) <= 0.0) continue;
    layout.source.fail(at.line, at.child, fmt::format("is no wheel: {}; without it, {}", rejected.reason, what));
  }
  if (joint != nullptr) layout.source.fail(joint->line, joint->name, what);
  throw InputError(fmt::format("{}: {}", layout.source.file, what));
}

void find_drive(RobotLayout& layout, const NormalizeOptions& options, std::vector<Assumption>& rows) {
  const bool may_have_legs = options.drive.empty() || options.drive == "legs";
  if (may_have_legs) layout.legs = find_legs(layout.source);
  if (!layout.legs.empty()) {
    layout.drive = DriveType::kLegs;
    for (const FoundLeg& leg : layout.legs) layout.kept.insert(leg.joints.begin(), leg.joints.end());
    return;
  }
  if (options.drive == "legs") {
    throw InputError(layout.source.file +
                     ": drive legs: the robot must have four legs of three revolute joints each, one behind the other");
  }
  layout.found = find_wheels(layout.source);
  for (const Assumption& assumption : layout.found.assumptions) rows.push_back(assumption);
  choose_carriers(layout, options, rows);
}

void choose_motors(RobotLayout& layout, std::vector<Assumption>& rows) {
  for (const FoundWheel* wheel : motorized_wheels(layout, rows)) layout.driven.insert(wheel->joint);
  drive_mimics(layout, rows);
  check_driven_sides(layout);
  check_fixed_sides(layout);
}

std::optional<RollerChoice> choose_rollers(const RobotLayout& layout, const NormalizeOptions& options,
                                           std::vector<Assumption>& rows) {
  const std::vector<FoundWheel>& wheels = layout.found.wheels;
  const bool may_be_mecanum = options.drive.empty() && layout.drive == DriveType::kDifferential && wheels.size() == 4;
  if (may_be_mecanum && layout.driven.size() == 4) {
    rows.push_back({"drive", "skid steering: the file has no rollers on the four driven wheels", "--drive mecanum"});
  }
  if (layout.drive != DriveType::kMecanum) return std::nullopt;
  if (wheels.size() != 4) {
    const SourceJoint& joint = *wheels.back().joint;
    layout.source.fail(joint.line, joint.name,
                       fmt::format("one of {} wheels: a mecanum drive must have four", wheels.size()));
  }
  double middle_x_m = 0.0;
  for (const FoundWheel& wheel : wheels) middle_x_m += 0.25 * wheel.center_m.x();
  const RollerCount count = count_rollers(layout, middle_x_m);
  if (count.num_x + count.num_o == 0) {
    rows.push_back(
        {"rollers",
         "axes at 45 degrees to the axle; seen from above, those of the upper rollers form an X: the file has none",
         "wheel_drive: roller_pattern, roller_angle_rad in the settings"});
    return RollerChoice{};
  }
  check_pattern(layout, count, middle_x_m);
  rows.push_back({"rollers",
                  fmt::format("{} links on joints are fixed to their wheels: the simulator replaces them by the "
                              "friction of the wheels",
                              layout.found.roller_joints.size()),
                  "none: rollers have no bodies in the simulator"});
  return RollerChoice{.pattern = count.num_x == 4 ? "x" : "o", .angle_rad = 0.25 * count.sum_rad};
}

void report_frozen_joints(const RobotLayout& layout, std::vector<Assumption>& rows) {
  std::vector<std::string> names;
  for (const SourceJoint& joint : layout.source.joints) {
    if (joint.type == JointType::kFixed || layout.kept.contains(&joint)) continue;
    if (layout.found.roller_joints.contains(&joint) || layout.casters.contains(&joint)) continue;
    const bool is_above_base = !layout.T_root_link.contains(joint.child) ||
                               (joint.child == layout.base && layout.source.root().name == joint.parent);
    if (is_above_base && joint.type == JointType::kFloating) continue;
    names.push_back(joint.name);
    const bool has_limits = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
    if (!has_limits || (joint.lower <= 0.0 && joint.upper >= 0.0)) continue;
    rows.push_back({joint.name,
                    fmt::format("zero, at which it is fixed, is outside its limits {:.3g} to {:.3g} {}", joint.lower,
                                joint.upper, joint.type == JointType::kRevolute ? "rad" : "m"),
                    "<origin> and <limit lower upper> of the joint"});
  }
  if (names.empty()) return;
  rows.push_back(
      {list_of(names), "fixed at zero: not joints of wheels or legs", "none: other joints are not simulated"});
}

}  // namespace patrol::importer
