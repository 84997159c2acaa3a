#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "importer/normalizer.h"
#include "io/files/one_line.h"

namespace patrol::importer {

void Normalizer::check_options() const {
  if (!options_.base_link.empty() && source_.find_link(options_.base_link) == nullptr)
    throw InputError(fmt::format("{}: base link {}: unknown link", source_.file, io::on_one_line(options_.base_link)));
  for (const std::string& link : options_.casters) {
    if (source_.find_link(link) == nullptr)
      throw InputError(fmt::format("{}: caster {}: unknown link", source_.file, io::on_one_line(link)));
  }
  for (const auto& [frame, link] : options_.frames) {
    if (std::find(kSensorFrames.begin(), kSensorFrames.end(), frame) == kSensorFrames.end()) {
      throw InputError(fmt::format("{}: frame {}: unknown sensor frame: must be {}", source_.file,
                                   io::on_one_line(frame), list_of({kSensorFrames.begin(), kSensorFrames.end()})));
    }
    if (source_.find_link(link) == nullptr)
      throw InputError(fmt::format("{}: frame {}: unknown link {}", source_.file, frame, io::on_one_line(link)));
  }
  const std::set<std::string> drives = {"", "differential", "ackermann", "mecanum", "legs"};
  if (!drives.contains(options_.drive)) {
    throw InputError(fmt::format("{}: drive {}: must be differential, ackermann, mecanum or legs", source_.file,
                                 io::on_one_line(options_.drive)));
  }
  const std::set<std::string> directions = {"", "x", "-x", "y", "-y"};
  if (!directions.contains(options_.forward)) {
    throw InputError(
        fmt::format("{}: forward {}: must be x, -x, y or -y", source_.file, io::on_one_line(options_.forward)));
  }
}

/// Finds the legs or the wheels.
void Normalizer::find_drive() {
  const bool may_have_legs = options_.drive.empty() || options_.drive == "legs";
  if (may_have_legs) legs_ = find_legs(source_);
  if (!legs_.empty()) {
    result_.drive = DriveType::kLegs;
    for (const FoundLeg& leg : legs_) kept_.insert(leg.joints.begin(), leg.joints.end());
    return;
  }
  if (options_.drive == "legs") {
    throw InputError(source_.file +
                     ": drive legs: the robot must have four legs of three revolute joints each, one behind the other");
  }
  found_ = find_wheels(source_);
  for (const Assumption& assumption : found_.assumptions) result_.assumptions.push_back(assumption);
  choose_carriers();
}

bool Normalizer::is_near_ground(double bottom_m) const {
  double max_radius_m = 0.0;
  for (const FoundWheel& wheel : found_.wheels) max_radius_m = std::max(max_radius_m, wheel.radius_m);
  return std::abs(bottom_m - ground_m_) <= 0.02 * max_radius_m + 0.005;
}

/// Refuses a caster whose wheels are far apart: it is the axle of a trailer or a wagon. Both wheels of a caster are
/// close together.
void Normalizer::check_caster(const FoundWheel& wheel) const {
  constexpr double kMinAxle = 3.0;  // to the radius
  for (const FoundWheel& other : found_.wheels) {
    if (other.carrier != wheel.carrier || (other.center_m - wheel.center_m).norm() < kMinAxle * wheel.radius_m)
      continue;
    source_.fail(wheel.carrier->line, wheel.carrier->name,
                 "swivels with a whole axle: trailers, articulated robots and turntable steering are not supported");
  }
}

/// Decides about endless joints with motors above wheels, and about steering that the option removes.
void Normalizer::choose_carriers() {
  std::size_t num_steered = 0;
  for (FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) check_caster(wheel);
    if (wheel.carrier_type != CarrierType::kSteering) continue;
    if (options_.drive == "differential") {
      assume(wheel.carrier->name, "steering is fixed straight ahead: the drive is differential", "--drive ackermann");
      kept_.erase(wheel.carrier);
      wheel.carrier_type = CarrierType::kNone;
      continue;
    }
    ++num_steered;
    for (const FoundWheel& other : found_.wheels) {
      if (other.carrier != wheel.carrier || (other.center_m - wheel.center_m).norm() < 1.5 * wheel.radius_m) continue;
      source_.fail(wheel.carrier->line, wheel.carrier->name,
                   "steers a whole axle: articulated robots and turntable steering are not supported");
    }
  }
  if (num_steered > 0 && num_steered == found_.wheels.size()) {
    const SourceJoint& joint = *found_.wheels.front().carrier;
    source_.fail(joint.line, joint.name, all_steered(num_steered));
  }
  if (options_.drive == "ackermann" && num_steered == 0) {
    throw InputError(
        fmt::format("{}: drive ackermann: no wheel is below a revolute joint about the vertical", source_.file));
  }
  const bool has_rollers = std::any_of(found_.wheels.begin(), found_.wheels.end(),
                                       [](const FoundWheel& wheel) { return wheel.num_rollers > 0; });
  if (has_rollers && options_.drive != "" && options_.drive != "mecanum")
    throw InputError(
        fmt::format("{}: drive {}: the wheels have rollers: must be mecanum", source_.file, options_.drive));
  result_.drive = has_rollers || options_.drive == "mecanum" ? DriveType::kMecanum
                  : num_steered > 0                          ? DriveType::kAckermann
                                                             : DriveType::kDifferential;
}

/// Refuses the wheels that were found. Names the link with a motor that is no wheel and carries none, which often is
/// the reason; without one, the joint; without a joint, only the file.
void Normalizer::fail_for_wheels(const SourceJoint* joint, const std::string& what) const {
  for (const RejectedWheel& rejected : found_.rejected) {
    const SourceJoint& at = *rejected.joint;
    if (std::any_of(found_.wheels.begin(), found_.wheels.end(),
                    [&at](const FoundWheel& wheel) { return wheel.carrier == &at; }))
      continue;
    if (!source_.motors.contains(at.name) && at.effort.value_or(0.0) <= 0.0) continue;
    source_.fail(at.line, at.child, fmt::format("is no wheel: {}; without it, {}", rejected.reason, what));
  }
  if (joint != nullptr) source_.fail(joint->line, joint->name, what);
  throw InputError(fmt::format("{}: {}", source_.file, what));
}

/// Checks that wheels that are not steered are on both sides; if motors drive any of these, that driven ones are.
void Normalizer::check_fixed_sides(const std::vector<const FoundWheel*>& wheels) const {
  bool is_any_driven = false;
  for (const FoundWheel* wheel : wheels)
    is_any_driven = is_any_driven || (wheel->carrier_type == CarrierType::kNone && driven_.contains(wheel->joint));
  const FoundWheel* left = nullptr;
  const FoundWheel* right = nullptr;
  for (const FoundWheel* wheel : wheels) {
    if (wheel->carrier_type != CarrierType::kNone || (is_any_driven && !driven_.contains(wheel->joint))) continue;
    (wheel->center_m.y() > 0.0 ? left : right) = wheel;
  }
  if (left != nullptr && right != nullptr) return;
  const SourceJoint& joint = *wheels.front()->joint;
  const SourceJoint& at = left != nullptr ? *left->joint : right != nullptr ? *right->joint : joint;
  fail_for_wheels(&at, "wheels that are not steered are on one side only: both sides must have one");
}

/// Chooses the wheels with motors.
void Normalizer::choose_drive() {
  std::vector<const FoundWheel*> candidates, named, limited, unsteered, mimicking;
  for (const FoundWheel& wheel : found_.wheels) {
    if (wheel.carrier_type == CarrierType::kCaster) continue;
    candidates.push_back(&wheel);
    if (source_.motors.contains(wheel.joint->name)) named.push_back(&wheel);
    if (wheel.joint->effort.value_or(0.0) > 0.0 && wheel.joint->velocity.value_or(0.0) > 0.0) limited.push_back(&wheel);
    if (wheel.carrier_type == CarrierType::kNone) unsteered.push_back(&wheel);
    if (wheel.joint->is_mimic) mimicking.push_back(&wheel);
  }
  std::vector<const FoundWheel*> chosen = !named.empty() ? named : limited;
  if (chosen.empty()) {
    chosen = unsteered;
    std::vector<std::string> names;
    for (const FoundWheel* wheel : chosen) names.push_back(wheel->joint->name);
    assume("drive", fmt::format("motors drive {}: the file names no motors", list_of(names)),
           "<limit effort velocity> of the driven wheels' joints, or <transmission>");
  }
  for (const FoundWheel* wheel : chosen) driven_.insert(wheel->joint);
  const auto has_motor = [this](const SourceJoint& joint) {
    return driven_.contains(&joint) || source_.motors.contains(joint.name) || joint.effort.value_or(0.0) > 0.0;
  };
  const std::set<const SourceJoint*> driven_alone = driven_;
  for (const FoundWheel* wheel : mimicking) {
    const SourceJoint* at = source_.find_joint(wheel->joint->mimicked);
    while (at->is_mimic && !has_motor(*at)) at = source_.find_joint(at->mimicked);
    if (has_motor(*at)) {
      driven_.insert(wheel->joint);
      const bool is_wheel = driven_alone.contains(at);
      assume(
          wheel->joint->name,
          fmt::format("has a motor: its <mimic> follows {}{}", is_wheel ? "a driven wheel, " : "the motor ", at->name),
          "<mimic> of the joint");
    } else if (!driven_.contains(wheel->joint)) {
      assume(wheel->joint->name, fmt::format("has no motor: its <mimic> follows {}, which has none", at->name),
             "<mimic> of the joint");
    }
  }
  double min_y = std::numeric_limits<double>::infinity(), max_y = -min_y;
  for (const FoundWheel* wheel : candidates) {
    if (!driven_.contains(wheel->joint)) continue;
    min_y = std::min(min_y, wheel->center_m.y());
    max_y = std::max(max_y, wheel->center_m.y());
  }
  if (min_y > 0.0 || max_y < 0.0 || max_y - min_y < 1e-3) {
    constexpr double kMiddle_m = 0.01;
    const bool is_in_middle = std::max(std::abs(min_y), std::abs(max_y)) < kMiddle_m;
    fail_for_wheels(*driven_.begin(),
                    is_in_middle ? "the driven wheel is in the middle: not supported: wheels on both sides must be "
                                   "driven, each on a joint of its own"
                                 : "driven wheels on one side only: both sides must be driven");
  }
  check_fixed_sides(candidates);
}

/// Checks the wheels of a mecanum drive, and takes the pattern of the rollers from their joints.
void Normalizer::choose_rollers() {
  const bool may_be_mecanum =
      options_.drive.empty() && result_.drive == DriveType::kDifferential && found_.wheels.size() == 4;
  if (may_be_mecanum && driven_.size() == 4)
    assume("drive", "skid steering: the file has no rollers on the four driven wheels", "--drive mecanum");
  if (result_.drive != DriveType::kMecanum) return;
  if (found_.wheels.size() != 4) {
    const SourceJoint& joint = *found_.wheels.back().joint;
    source_.fail(joint.line, joint.name,
                 fmt::format("one of {} wheels: a mecanum drive must have four", found_.wheels.size()));
  }
  double middle_x_m = 0.0;
  for (const FoundWheel& wheel : found_.wheels) middle_x_m += 0.25 * wheel.center_m.x();
  int num_x = 0, num_o = 0;
  double sum_rad = 0.0;
  std::set<std::pair<bool, bool>> corners;
  for (const FoundWheel& wheel : found_.wheels) {
    const SourceJoint& joint = *wheel.joint;
    if (wheel.carrier_type != CarrierType::kNone)
      source_.fail(joint.line, joint.name, "is below a vertical joint: a wheel of a mecanum drive must not swivel");
    if (!driven_.contains(&joint))
      source_.fail(joint.line, joint.name, "has no motor: all wheels of a mecanum drive must be driven");
    const bool is_front = wheel.center_m.x() > middle_x_m, is_left = wheel.center_m.y() > 0.0;
    if (!corners.insert({is_front, is_left}).second)
      source_.fail(joint.line, joint.name, "each side of a mecanum drive must have a front and a rear wheel");
    if (wheel.num_rollers == 0) continue;
    ++((wheel.roller_axis_rad < 0.0) == (is_front == is_left) ? num_x : num_o);
    sum_rad += 0.5 * std::numbers::pi - std::abs(wheel.roller_axis_rad);
  }
  if (num_x + num_o == 0) {
    assume("rollers",
           "axes at 45 degrees to the axle; seen from above, those of the upper rollers form an X: the file has none",
           "wheel_drive: roller_pattern, roller_angle_rad in the settings");
    return;
  }
  if (num_x != 4 && num_o != 4) {
    const SourceJoint& joint = *found_.wheels.front().joint;
    source_.fail(joint.line, joint.name,
                 fmt::format("rollers of {} wheels form an X seen from above, those of {} an O: must be four of a kind",
                             num_x, num_o));
  }
  for (const FoundWheel& wheel : found_.wheels) {
    const double x_m = std::abs(wheel.center_m.x() - middle_x_m), y_m = std::abs(wheel.center_m.y());
    const double reach_m = x_m * std::tan(std::abs(wheel.roller_axis_rad));
    if (num_x == 4 || std::abs(reach_m - y_m) > 0.1 * (reach_m + y_m)) continue;
    source_.fail(wheel.joint->line, wheel.joint->name,
                 "rollers on the ground point at the middle of the robot: the wheels do not turn it");
  }
  result_.roller_pattern = num_x == 4 ? "x" : "o";
  result_.roller_angle_rad = 0.25 * sum_rad;
  assume("rollers",
         fmt::format("{} links on joints are fixed to their wheels: the simulator replaces them by the friction of the "
                     "wheels",
                     found_.roller_joints.size()),
         "none: rollers have no bodies in the simulator");
}

void Normalizer::report_frozen_joints() {
  std::vector<std::string> names;
  for (const SourceJoint& joint : source_.joints) {
    if (joint.type == JointType::kFixed || kept_.contains(&joint)) continue;
    if (found_.roller_joints.contains(&joint) || casters_.contains(&joint)) continue;
    const bool is_above_base =
        !T_root_link_.contains(joint.child) || (joint.child == base_ && source_.root().name == joint.parent);
    if (is_above_base && joint.type == JointType::kFloating) continue;
    names.push_back(joint.name);
    const bool has_limits = joint.type == JointType::kRevolute || joint.type == JointType::kPrismatic;
    if (!has_limits || (joint.lower <= 0.0 && joint.upper >= 0.0)) continue;
    assume(joint.name,
           fmt::format("zero, at which it is fixed, is outside its limits {:.3g} to {:.3g} {}", joint.lower,
                       joint.upper, joint.type == JointType::kRevolute ? "rad" : "m"),
           "<origin> and <limit lower upper> of the joint");
  }
  if (names.empty()) return;
  assume(list_of(names), "fixed at zero: not joints of wheels or legs", "none: other joints are not simulated");
}

std::string Normalizer::unique(std::set<std::string>& used, const std::string& wanted,
                               const std::string& suffix) const {
  std::string name = wanted;
  for (int i = 2; used.contains(name); ++i)
    name = i == 2 ? wanted + suffix : fmt::format("{}{}_{}", wanted, suffix, i - 1);
  used.insert(name);
  return name;
}

/// Reserves the names of Patrol's own frames, so that no link of the file has one of them by chance.
void Normalizer::reserve_names() {
  used_links_.insert({"base_link", "world"});
  for (const char* frame : kSensorFrames) used_links_.insert(frame);
}

std::string Normalizer::link_name(const std::string& source_name) {
  if (source_name == base_) return "base_link";
  if (const auto found = link_names_.find(source_name); found != link_names_.end()) return found->second;
  std::string name = is_reserved_link(source_name) ? source_name + "_part" : source_name;
  name = unique(used_links_, name, "_part");
  link_names_[source_name] = name;
  result_.source_links[name] = source_name;
  if (name != source_name)
    assume(source_name, fmt::format("is renamed to {}: the name has a meaning in Patrol", name), "name of the link");
  return name;
}

std::string Normalizer::joint_name(const std::string& source_name) {
  if (const auto found = joint_names_.find(source_name); found != joint_names_.end()) return found->second;
  const std::string name =
      unique(used_joints_, is_reserved_joint(source_name) ? "joint_" + source_name : source_name, "_joint");
  joint_names_[source_name] = name;
  return name;
}

NormalizedRobot Normalizer::run() {
  check_options();
  measure_box();
  check_centers();
  find_drive();
  choose_base();
  if (result_.drive == DriveType::kLegs) {
    choose_legged_frame();
  } else {
    choose_frame();
    choose_drive();
    release_fixed_casters();
    choose_rollers();
  }
  report_frozen_joints();
  reserve_names();
  if (result_.drive == DriveType::kLegs) {
    add_chassis();
    add_legs();
  } else {
    refuse_unturned_wheels();
    add_supports();
    add_chassis();
    add_wheels();
    const double mass_kg = total_mass_kg();
    strengthen_casters(mass_kg);
    for (const Support& support : supports_) add_support(support, mass_kg);
    report_frictions();
  }
  add_sensors();
  choose_scan_band();
  finish();
  return std::move(result_);
}

NormalizedRobot normalize(const SourceRobot& source, const NormalizeOptions& options) {
  return Normalizer(source, options).run();
}

}  // namespace patrol::importer
