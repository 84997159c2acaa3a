#include "importer/robot/wheel_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "importer/robot/axial_shape.h"

namespace patrol::importer {
namespace {

constexpr double kHorizontal = 0.05;  // 2.9 degrees
constexpr double kVertical = 0.966;   // 15 degrees, for king pins and caster angles
constexpr int kMinRollers = 4;
constexpr double kMinRollerAngle_rad = 0.35, kMaxRollerAngle_rad = 1.22;  // to the axle, of mecanum wheels
constexpr double kMaxRollerSpread_rad = 0.1;                              // of the angles of a wheel

/// Returns the height of a wheel above the lowest one up to which it touches the ground.
double ground_gap_m(const FoundWheel& wheel) {
  constexpr double kMaxReaderGap_m = 0.01;
  return std::min(0.02 * wheel.radius_m + 0.005, kMaxReaderGap_m);
}

/// Finder of the wheels of one description.
class WheelFinder {
 public:
  explicit WheelFinder(const SourceRobot& robot) : robot_(robot), T_root_link_(link_poses(robot)) {
    for (const SourceJoint& joint : robot.joints) {
      if (joint.is_endless()) endless_.insert(&joint);
    }
  }

  FoundWheels find();
  bool has_candidates();

 private:
  void find_candidates();
  std::optional<FoundWheel> measure_wheel(const SourceJoint& joint);
  void find_rollers();
  bool axes_meet(const SourceJoint& a, const SourceJoint& b) const;
  void use_rollers(const Pose3& T_root_axis, FoundWheel& wheel) const;
  void find_carrier(FoundWheel& wheel);
  bool is_above_all_wheels(const SourceJoint& joint) const;
  bool swivels(const SourceJoint& joint) const;
  void check_upright() const;
  void refuse_one_low_wheel() const;
  void keep_wheels_on_ground();
  void leave_out_passive_balls();
  std::string reason_without_wheels() const;
  std::vector<AxialShape> axial_shapes(const std::vector<const SourceLink*>& links, const Pose3& T_root_axis,
                                       bool is_visual) const;

  const SourceRobot& robot_;
  std::map<std::string, Pose3> T_root_link_;
  std::set<const SourceJoint*> endless_;                                   ///< endless joints without those of rollers
  std::map<const SourceJoint*, std::vector<const SourceJoint*>> rollers_;  ///< joints of rollers, by joint of the wheel
  FoundWheels found_;
  std::set<const SourceJoint*> reported_;  ///< joints of casters with a range
};

std::vector<AxialShape> WheelFinder::axial_shapes(const std::vector<const SourceLink*>& links, const Pose3& T_root_axis,
                                                  bool is_visual) const {
  std::vector<AxialShape> shapes;
  for (const SourceLink* link : links) {
    const Pose3 T_axis_link = T_root_axis.inverse() * T_root_link_.at(link->name);
    for (const Shape& shape : is_visual ? link->visuals : link->collisions)
      shapes.push_back(axial_shape(shape, T_axis_link));
  }
  return shapes;
}

/// Returns whether the axes of two joints intersect or are the same: those of a gear, for example, but not those of a
/// wheel and its roller.
bool WheelFinder::axes_meet(const SourceJoint& a, const SourceJoint& b) const {
  constexpr double kMeet_m = 1e-3, kParallel = 1e-3;
  const Pose3 &T_root_a = T_root_link_.at(a.child), &T_root_b = T_root_link_.at(b.child);
  const Eigen::Vector3d along_a = T_root_a.rotation * a.axis, along_b = T_root_b.rotation * b.axis;
  const Eigen::Vector3d between = T_root_b.position - T_root_a.position, normal = along_a.cross(along_b);
  if (normal.norm() < kParallel) return (between - between.dot(along_a) * along_a).norm() < kMeet_m;
  return std::abs(between.dot(normal.normalized())) < kMeet_m;
}

/// Finds the rollers of wheels and takes their joints from the endless ones. A motor never drives a roller.
void WheelFinder::find_rollers() {
  const auto wheel_above = [this](const SourceJoint& joint) -> const SourceJoint* {
    for (const SourceJoint* at = robot_.parent_joint(joint.parent); at != nullptr;
         at = robot_.parent_joint(at->parent)) {
      const Eigen::Vector3d axis = T_root_link_.at(at->child).rotation * at->axis;
      if (endless_.contains(at) && std::abs(axis.z()) <= kHorizontal) return at;
    }
    return nullptr;
  };
  for (const SourceJoint& joint : robot_.joints) {
    if (!endless_.contains(&joint) || robot_.motors.contains(joint.name)) continue;
    const SourceJoint* wheel = wheel_above(joint);
    if (wheel != nullptr && !axes_meet(*wheel, joint)) rollers_[wheel].push_back(&joint);
  }
  std::erase_if(rollers_, [](const auto& entry) { return static_cast<int>(entry.second.size()) < kMinRollers; });
  for (const auto& [wheel, joints] : rollers_) found_.roller_joints.insert(joints.begin(), joints.end());
  std::erase_if(rollers_, [this](const auto& entry) { return found_.roller_joints.contains(entry.first); });
  for (const SourceJoint* joint : found_.roller_joints) endless_.erase(joint);
}

/// Takes the radius, the width and the middle of a wheel from its rollers, and the direction of their axes. With the
/// axle y and the outward direction u of a roller, the forward direction at the ground is -y x u in its frame.
void WheelFinder::use_rollers(const Pose3& T_root_axis, FoundWheel& wheel) const {
  const auto found = rollers_.find(wheel.joint);
  if (found == rollers_.end()) return;
  const auto fail = [&wheel, this](const std::string& what) {
    robot_.fail(wheel.joint->line, wheel.joint->child,
                fmt::format("has {} rollers on joints: {}", wheel.num_rollers, what));
  };
  wheel.num_rollers = static_cast<int>(found->second.size());
  std::vector<double> radii_m, angles_rad;
  double min_m = std::numeric_limits<double>::infinity(), max_m = -min_m;
  for (const SourceJoint* joint : found->second) {
    const Pose3& T_root_roller = T_root_link_.at(joint->child);
    const Eigen::Vector3d direction = T_root_axis.rotation.conjugate() * (T_root_roller.rotation * joint->axis);
    const Pose3 T_root_own{T_root_roller.position,
                           rotation_between(Eigen::Vector3d::UnitZ(), T_root_roller.rotation * joint->axis)};
    const std::vector<const SourceLink*> links = rigid_group(robot_, joint->child, endless_);
    std::vector<AxialShape> shapes = axial_shapes(links, T_root_own, false);
    if (shapes.empty()) shapes = axial_shapes(links, T_root_own, true);
    if (shapes.empty()) fail(fmt::format("roller {} has no shape", joint->child));
    AxialShape roller = shapes.front();
    for (const AxialShape& shape : shapes) {
      roller.radius_m = std::max(roller.radius_m, shape.radius_m);
      roller.min_m = std::min(roller.min_m, shape.min_m);
      roller.max_m = std::max(roller.max_m, shape.max_m);
    }
    const Eigen::Vector3d center =
        T_root_axis.inverse() * (T_root_own * Eigen::Vector3d(0.0, 0.0, 0.5 * (roller.min_m + roller.max_m)));
    const Eigen::Vector3d outward = Eigen::Vector3d(center.x(), center.y(), 0.0);
    if (outward.norm() < roller.radius_m) fail(fmt::format("roller {} is on the axle of the wheel", joint->child));
    radii_m.push_back(outward.norm() + roller.radius_m);
    const double half_m = 0.5 * (roller.max_m - roller.min_m) * std::abs(direction.z());
    min_m = std::min(min_m, center.z() - half_m);
    max_m = std::max(max_m, center.z() + half_m);
    const Eigen::Vector3d forward = outward.normalized().cross(Eigen::Vector3d::UnitZ());
    const double along = direction.dot(forward);
    angles_rad.push_back(std::atan2(along < 0.0 ? -direction.z() : direction.z(), std::abs(along)));
  }
  double sum_rad = 0.0;
  for (const double angle : angles_rad) sum_rad += angle;
  wheel.roller_axis_rad = sum_rad / static_cast<double>(angles_rad.size());
  for (const double angle : angles_rad) {
    if (std::abs(angle - wheel.roller_axis_rad) > kMaxRollerSpread_rad)
      fail("not supported: their axes are at different angles to the axle");
  }
  const double to_axle_rad = 0.5 * std::numbers::pi - std::abs(wheel.roller_axis_rad);
  if (to_axle_rad < kMinRollerAngle_rad || to_axle_rad > kMaxRollerAngle_rad) {
    fail(fmt::format("not supported: their axes are at {:.0f} degrees to the axle, those of a mecanum wheel are at 45",
                     to_deg(to_axle_rad)));
  }
  std::nth_element(radii_m.begin(), radii_m.begin() + static_cast<std::ptrdiff_t>(radii_m.size() / 2), radii_m.end());
  wheel.radius_m = radii_m[radii_m.size() / 2];
  wheel.width_m = max_m - min_m;
  wheel.center_m = T_root_axis * Eigen::Vector3d(0.0, 0.0, 0.5 * (min_m + max_m));
  wheel.is_ball = false;
}

std::optional<FoundWheel> WheelFinder::measure_wheel(const SourceJoint& joint) {
  const Pose3& T_root_child = T_root_link_.at(joint.child);
  const Eigen::Vector3d axis = T_root_child.rotation * joint.axis;
  if (std::abs(axis.z()) > kHorizontal) {
    found_.rejected.push_back({&joint, fmt::format("the axis of joint {} is not horizontal", joint.name)});
    return std::nullopt;
  }
  const Pose3 T_root_axis{T_root_child.position, rotation_between(Eigen::Vector3d::UnitZ(), axis)};
  const std::vector<const SourceLink*> links = rigid_group(robot_, joint.child, endless_);
  const std::vector<AxialShape> collisions = axial_shapes(links, T_root_axis, false);
  const std::vector<AxialShape> visuals = axial_shapes(links, T_root_axis, true);
  const std::optional<AxialShape> by_collision = round_hull(collisions), by_visual = round_hull(visuals);
  const std::optional<AxialShape>& wheel = by_collision ? by_collision : by_visual;
  if (!wheel && rollers_.contains(&joint)) {
    FoundWheel result{.joint = &joint, .axis = Eigen::Vector3d(axis.x(), axis.y(), 0.0).normalized()};
    use_rollers(T_root_axis, result);
    return result;
  }
  if (!wheel) {
    found_.rejected.push_back({&joint, fmt::format("is not round about the axis of joint {}", joint.name)});
    return std::nullopt;
  }
  FoundWheel result{.joint = &joint,
                    .axis = Eigen::Vector3d(axis.x(), axis.y(), 0.0).normalized(),
                    .radius_m = wheel->radius_m,
                    .width_m = wheel->rim_max_m - wheel->rim_min_m};
  double middle_m = 0.5 * (wheel->rim_max_m + wheel->rim_min_m);
  if (wheel->is_sphere) {
    result.is_ball = true;
    result.width_m = wheel->radius_m;
    if (by_visual && !by_visual->is_sphere &&
        std::abs(by_visual->radius_m - wheel->radius_m) < 0.15 * wheel->radius_m) {
      result.width_m = by_visual->rim_max_m - by_visual->rim_min_m;
      middle_m = 0.5 * (by_visual->rim_max_m + by_visual->rim_min_m);
      result.is_ball = false;
    }
  }
  result.center_m = T_root_axis * Eigen::Vector3d(0.0, 0.0, middle_m);
  use_rollers(T_root_axis, result);
  return result;
}

/// Returns whether a joint is above all of at least three wheels: no joint of a steered axle.
bool WheelFinder::is_above_all_wheels(const SourceJoint& joint) const {
  const auto is_above = [this, &joint](const FoundWheel& wheel) {
    const SourceJoint* at = robot_.parent_joint(wheel.joint->parent);
    while (at != nullptr && at != &joint) at = robot_.parent_joint(at->parent);
    return at == &joint;
  };
  return found_.wheels.size() > 2 && std::all_of(found_.wheels.begin(), found_.wheels.end(), is_above);
}

/// Returns whether a vertical joint above a wheel is that of a caster: it has no motor and turns by a full turn.
bool WheelFinder::swivels(const SourceJoint& joint) const {
  constexpr double kFullTurn_rad = 2.0 * std::numbers::pi - 0.05;
  if (robot_.motors.contains(joint.name)) return false;
  if (joint.is_endless()) return true;
  const bool has_motor = robot_.motors.empty() && joint.effort.value_or(0.0) > 0.0;
  return !has_motor && joint.upper - joint.lower >= kFullTurn_rad;
}

/// Finds the nearest vertical joint above a wheel: that of a caster or a steering joint.
void WheelFinder::find_carrier(FoundWheel& wheel) {
  for (const SourceJoint* at = robot_.parent_joint(wheel.joint->parent); at != nullptr;
       at = robot_.parent_joint(at->parent)) {
    if (at->type != JointType::kRevolute && at->type != JointType::kContinuous) continue;
    const Eigen::Vector3d axis = T_root_link_.at(at->child).rotation * at->axis;
    if (std::abs(axis.z()) < kVertical || is_above_all_wheels(*at) || robot_.moves_whole_robot(*at)) continue;
    wheel.carrier = at;
    wheel.carrier_type = swivels(*at) ? CarrierType::kCaster : CarrierType::kSteering;
    if (wheel.carrier_type == CarrierType::kCaster && !at->is_endless() && reported_.insert(at).second) {
      found_.assumptions.push_back(
          {.subject = at->name,
           .text = "swivels without end, although the file limits it: it turns by a full turn and has no motor",
           .override_with = "<limit lower upper effort> of the joint"});
    }
    return;
  }
}

/// Refuses a robot that lies on its front or back: all of at least three wheels touch a plane that is upright, as in
/// files whose y axis is up.
void WheelFinder::check_upright() const {
  if (found_.wheels.size() < 3) return;
  const Eigen::Vector3d horizontal = found_.wheels.front().axis.cross(Eigen::Vector3d::UnitZ());
  const auto spread = [this](const Eigen::Vector3d& up) {
    double min_m = std::numeric_limits<double>::infinity(), max_m = -min_m, min_radius_m = min_m;
    for (const FoundWheel& wheel : found_.wheels) {
      const double bottom_m = up.dot(wheel.center_m) - wheel.radius_m;
      min_m = std::min(min_m, bottom_m);
      max_m = std::max(max_m, bottom_m);
      min_radius_m = std::min(min_radius_m, wheel.radius_m);
    }
    return (max_m - min_m) / min_radius_m;
  };
  constexpr double kFlat = 0.05, kUpright = 1.0;  // to the smallest radius
  if (spread(Eigen::Vector3d::UnitZ()) < kUpright) return;
  if (std::min(spread(horizontal), spread(-horizontal)) > kFlat) return;
  const SourceJoint& joint = *found_.wheels.front().joint;
  robot_.fail(joint.line, joint.name,
              fmt::format("the wheels touch one plane, but it is upright: z of {} must be up: add a root link with a "
                          "fixed joint that turns the robot",
                          robot_.root().name));
}

/// Refuses one wheel below at least two others that are on one plane.
void WheelFinder::refuse_one_low_wheel() const {
  if (found_.wheels.size() < 3) return;
  const auto is_lower = [](const FoundWheel& a, const FoundWheel& b) { return a.bottom_m() < b.bottom_m(); };
  const auto low = std::min_element(found_.wheels.begin(), found_.wheels.end(), is_lower);
  double min_m = std::numeric_limits<double>::infinity(), max_m = -min_m;  // of the others
  for (const FoundWheel& wheel : found_.wheels) {
    if (&wheel == &*low) continue;
    min_m = std::min(min_m, wheel.bottom_m());
    max_m = std::max(max_m, wheel.bottom_m());
  }
  const double below_m = min_m - low->bottom_m(), gap_m = ground_gap_m(*low);
  if (below_m <= gap_m || max_m - min_m > gap_m || below_m >= 0.5 * low->radius_m) return;
  robot_.fail(low->joint->line, low->joint->child,
              fmt::format("is {:.3f} m below the other wheels: all wheels must touch one plane", below_m));
}

/// Keeps the wheels on the ground plane. A candidate far above it is another round part, for example a spinning sensor.
void WheelFinder::keep_wheels_on_ground() {
  found_.ground_m = std::numeric_limits<double>::infinity();
  for (const FoundWheel& wheel : found_.wheels) found_.ground_m = std::min(found_.ground_m, wheel.bottom_m());
  refuse_one_low_wheel();
  std::erase_if(found_.wheels, [this](const FoundWheel& wheel) {
    const double above_m = wheel.bottom_m() - found_.ground_m;
    if (above_m <= ground_gap_m(wheel)) return false;
    if (above_m < 0.5 * wheel.radius_m) {
      robot_.fail(wheel.joint->line, wheel.joint->child,
                  fmt::format("is {:.3f} m above the lowest wheel: all wheels must touch one plane", above_m));
    }
    found_.rejected.push_back(
        {wheel.joint, fmt::format("is round, but {:.3f} m above the ground of the lowest wheel", above_m)});
    found_.assumptions.push_back(
        {.subject = wheel.joint->name,
         .text = fmt::format("is fixed at zero: its link is round, but {:.3f} m above the ground", above_m),
         .override_with = "<origin> of the joint"});
    return true;
  });
}

/// Leaves out balls without motors beside two other wheels: casters, whose joint about one axis is a stopgap.
void WheelFinder::leave_out_passive_balls() {
  const auto is_passive_ball = [this](const FoundWheel& wheel) {
    const bool has_motor = robot_.motors.contains(wheel.joint->name) || wheel.joint->effort.value_or(0.0) > 0.0;
    return wheel.is_ball && !has_motor && !wheel.joint->is_mimic;
  };
  const auto num_balls = std::count_if(found_.wheels.begin(), found_.wheels.end(), is_passive_ball);
  if (static_cast<std::ptrdiff_t>(found_.wheels.size()) - num_balls < 2) return;
  std::erase_if(found_.wheels, is_passive_ball);
}

void WheelFinder::find_candidates() {
  find_rollers();
  for (const SourceJoint& joint : robot_.joints) {
    if (!endless_.contains(&joint)) continue;
    if (const auto wheel = measure_wheel(joint)) found_.wheels.push_back(*wheel);
  }
}

bool WheelFinder::has_candidates() {
  find_candidates();
  return !found_.wheels.empty();
}

/// Returns the joint that most likely should turn a wheel and why it does not: a fixed one with a motor and a
/// horizontal axis, otherwise the last candidate; empty if there is none.
std::string WheelFinder::reason_without_wheels() const {
  for (const SourceJoint& joint : robot_.joints) {
    const Eigen::Vector3d axis = T_root_link_.at(joint.child).rotation * joint.axis;
    if (joint.type != JointType::kFixed || !robot_.motors.contains(joint.name)) continue;
    if (std::abs(axis.z()) <= kHorizontal)
      return fmt::format(" ({}: {}: has a motor, but is fixed)", robot_.short_location(joint.line), joint.name);
  }
  if (found_.rejected.empty()) return "";
  const RejectedWheel& last = found_.rejected.back();
  return fmt::format(" ({}: {}: {})", robot_.short_location(last.joint->line), last.joint->child, last.reason);
}

FoundWheels WheelFinder::find() {
  find_candidates();
  if (found_.wheels.empty()) {
    throw InputError(fmt::format(
        "{}: no wheels found: a wheel is a round link on a continuous joint about a horizontal axis that touches the "
        "ground{}; no legs either: a robot that walks has four, each of three revolute joints one behind the other",
        robot_.file, reason_without_wheels()));
  }
  check_upright();
  keep_wheels_on_ground();
  leave_out_passive_balls();
  for (FoundWheel& wheel : found_.wheels) find_carrier(wheel);
  return std::move(found_);
}

}  // namespace

std::map<std::string, Pose3> link_poses(const SourceRobot& robot) {
  std::map<std::string, Pose3> poses;
  std::vector<std::string> open = {robot.root().name};
  poses[open.front()] = {};
  while (!open.empty()) {
    const std::string parent = open.back();
    open.pop_back();
    for (const SourceJoint* joint : robot.child_joints(parent)) {
      Pose3 pose = poses.at(parent) * joint->T_parent_child;
      pose.rotation.normalize();
      poses[joint->child] = pose;
      open.push_back(joint->child);
    }
  }
  return poses;
}

std::vector<const SourceLink*> rigid_group(const SourceRobot& robot, const std::string& link,
                                           const std::set<const SourceJoint*>& kept) {
  std::vector<const SourceLink*> group = {&robot.link(link)};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const SourceJoint* joint : robot.child_joints(group[i]->name)) {
      if (!kept.contains(joint)) group.push_back(&robot.link(joint->child));
    }
  }
  return group;
}

bool has_wheels(const SourceRobot& robot) { return WheelFinder(robot).has_candidates(); }

FoundWheels find_wheels(const SourceRobot& robot) { return WheelFinder(robot).find(); }

}  // namespace patrol::importer
