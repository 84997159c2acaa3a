#include "importer/normalize.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/geometry/convex_polygon.h"
#include "core/geometry/linear_algebra.h"
#include "importer/hull.h"
#include "importer/wheel_finder.h"
#include "io/files/one_line.h"

namespace patrol::importer {
namespace {

constexpr double kGravity = 9.81;
constexpr double kFriction = 0.8;         // rubber on asphalt
constexpr double kDensity_kgpm3 = 500.0;  // of a link without mass
constexpr double kParallel_rad = 0.0447;  // 2.6 degrees, as io/urdf.cc
constexpr double kAssumedSpeed_mps = 1.5;
constexpr double kSupportMassRatio = 0.03;  // of balls in place of fixed supports, to the robot
constexpr std::size_t kManyTriangles = 20000;
constexpr std::array kSensorFrames = {"lidar", "lidar3d", "imu", "gnss", "depth_camera", "tdlas", "uwb"};

Pose3 translation(const Eigen::Vector3d& position) { return {.position = position}; }

/// Returns whether a name of a link has a meaning in Patrol.
bool is_reserved_link(const std::string& name) {
  static const std::set<std::string> kReserved = {
      "base_link",   "world",         "scanner",        "tem_mount",      "tem", "left_track",
      "right_track", "left_sprocket", "right_sprocket", "base_footprint", "map", "odom"};
  return kReserved.contains(name) ||
         std::find(kSensorFrames.begin(), kSensorFrames.end(), name) != kSensorFrames.end() ||
         name.starts_with("ultrasonic_") || name.ends_with("_foot");
}

bool is_reserved_joint(const std::string& name) { return name.starts_with("tem_") || name == "robot"; }

/// Returns a file name of ASCII letters, digits and underscores.
std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const bool is_plain =
        static_cast<unsigned char>(c) < 128 && (std::isalnum(static_cast<unsigned char>(c)) || c == '-');
    if (is_plain) stem += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!stem.ends_with('_')) stem += '_';
  }
  return stem.empty() || stem == "_" ? "mesh" : stem;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Inertial to_inertial(const SourceInertial& source) {
  return {.mass_kg = source.mass_kg, .T_link_inertia = source.T_link_inertia, .inertia = source.inertia};
}

/// Fixed part that slides on the ground: center in the base and radius.
struct Support {
  std::string name;
  Eigen::Vector3d center_m;
  double radius_m;
  std::string link;  ///< of the file, from which mass is taken; empty: base
};

/// Turns one description into the result.
class Normalizer {
 public:
  Normalizer(const SourceRobot& source, const NormalizeOptions& options)
      : source_(source), options_(options), T_root_link_(link_poses(source)) {
    result_.name = options.name.empty() ? source.name : options.name;
    result_.assumptions = source.assumptions;
  }

  NormalizedRobot run();

 private:
  void check_options() const;
  void assume(const std::string& subject, const std::string& text, const std::string& override_with) {
    result_.assumptions.push_back({subject, text, override_with});
  }
  void choose_base();
  void choose_frame();
  void choose_carriers();
  void choose_drive();
  void check_fixed_sides(const std::vector<const FoundWheel*>& wheels) const;
  void report_frozen_joints();
  void reserve_names();
  std::string unique(std::set<std::string>& used, const std::string& wanted, const std::string& suffix) const;
  std::string link_name(const std::string& source_name);
  std::string joint_name(const std::string& source_name);
  Pose3 T_base(const std::string& link) const { return T_root_base_.inverse() * T_root_link_.at(link); }
  bool is_near_ground(double bottom_m) const;

  void add_chassis();
  void add_wheels();
  void add_supports();
  void add_support(const Support& support, double robot_mass_kg);
  void add_sensors();
  void check_balance();
  void check_clearance();
  void add_frame(const std::string& frame, const Pose3& T_base_frame, const std::string& link);
  void finish();

  std::vector<const SourceLink*> moving_group(const SourceJoint& joint) const;
  Inertial moving_inertial(const std::vector<const SourceLink*>& links, const Pose3& T_base_new, const Pose3& T_adjust,
                           const std::vector<Shape>& fallback, const SourceJoint& joint);
  std::optional<Inertial> checked_inertial(const SourceLink& link);
  Inertial solid_inertial(const std::vector<Shape>& shapes, double mass_kg) const;
  void add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target);
  void add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals, NormalizedLink& target);
  std::string add_mesh(const std::string& stem, const Mesh& mesh);
  double total_mass_kg() const;
  Motor motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg);
  NormalizedLink& base() { return result_.links.front(); }

  const SourceRobot& source_;
  const NormalizeOptions& options_;
  std::map<std::string, Pose3> T_root_link_;
  FoundWheels found_;
  std::set<const SourceJoint*> kept_;    ///< movable joints of the result
  std::set<const SourceJoint*> driven_;  ///< wheel joints with motors
  std::set<std::string> chassis_;        ///< links of the base's rigid group
  std::string base_;                     ///< link of the file
  Pose3 T_root_base_;
  double ground_m_ = 0.0;  ///< height of the ground in the base
  std::set<std::string> used_links_, used_joints_;
  std::map<std::string, std::string> link_names_, joint_names_;  ///< source to result
  std::map<const void*, std::vector<std::pair<std::string, std::optional<Eigen::Vector4d>>>> mesh_files_;
  std::map<const void*, std::vector<std::string>> hull_files_;
  std::set<std::string> used_files_;
  std::set<std::pair<std::string, std::size_t>> support_shapes_;  ///< link and index of collisions made into supports
  std::vector<Support> supports_;
  std::vector<std::string> massless_;
  NormalizedRobot result_;
};

void Normalizer::check_options() const {
  if (!options_.base_link.empty() && source_.find_link(options_.base_link) == nullptr)
    throw InputError(fmt::format("{}: base link {}: unknown link", source_.file, io::on_one_line(options_.base_link)));
  for (const auto& [frame, link] : options_.frames) {
    if (std::find(kSensorFrames.begin(), kSensorFrames.end(), frame) == kSensorFrames.end()) {
      throw InputError(fmt::format("{}: frame {}: unknown sensor frame: must be {}", source_.file,
                                   io::on_one_line(frame), list_of({kSensorFrames.begin(), kSensorFrames.end()})));
    }
    if (source_.find_link(link) == nullptr)
      throw InputError(fmt::format("{}: frame {}: unknown link {}", source_.file, frame, io::on_one_line(link)));
  }
  const std::set<std::string> drives = {"", "differential", "ackermann", "mecanum"};
  if (!drives.contains(options_.drive)) {
    throw InputError(fmt::format("{}: drive {}: must be differential, ackermann or mecanum", source_.file,
                                 io::on_one_line(options_.drive)));
  }
  const std::set<std::string> directions = {"", "x", "-x", "y", "-y"};
  if (!directions.contains(options_.forward)) {
    throw InputError(
        fmt::format("{}: forward {}: must be x, -x, y or -y", source_.file, io::on_one_line(options_.forward)));
  }
}

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
      source_.fail(source_.link(base_).line, base_, "is on a wheel: the base link must be on the chassis");
    return;
  }
  base_ = root;
  while (true) {
    const SourceLink& link = source_.link(base_);
    const std::vector<const SourceJoint*> children = source_.child_joints(base_);
    const bool has_mass = link.inertial && link.inertial->mass_kg > 0.0;
    if (has_mass || link.has_shapes() || children.size() != 1 || kept_.contains(children.front())) break;
    base_ = children.front()->child;
  }
  // A massless root that carries sensors or casters beside the body is no base if one child carries all the wheels.
  if (base_ != "base_link") {
    assume("base_link", fmt::format("is the link {} of the file, renamed", base_), "--base-link LINK");
  }
}

/// Returns the angle of an axle relative to y of the base, in (-pi/2, pi/2].
double axle_angle_rad(const Eigen::Vector3d& axis) {
  double angle = std::atan2(-axis.x(), axis.y());
  if (angle <= -0.5 * std::numbers::pi + 1e-9) angle += std::numbers::pi;
  if (angle > 0.5 * std::numbers::pi + 1e-9) angle -= std::numbers::pi;
  return angle;
}

/// Chooses the frame base_link: the frame of the base link, level, with the axles along y and between the wheels.
void Normalizer::choose_frame() {
  const Pose3 T_root_link = T_root_link_.at(base_);
  T_root_base_ = remove_tilt(T_root_link);
  const double tilt = std::acos(std::clamp((T_root_link.rotation * Eigen::Vector3d::UnitZ()).z(), -1.0, 1.0));
  if (tilt < 1e-6) T_root_base_ = T_root_link;
  else
    assume("base_link", fmt::format("is leveled: {} is tilted by {:.1f} degrees", base_, tilt * kDegPerRad),
           "--base-link LINK");

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
  if (first == nullptr)
    throw InputError(source_.file + ": all wheels are casters: at least two wheels must not swivel");
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
  for (FoundWheel& wheel : found_.wheels) {
    wheel.center_m = T_root_base_.inverse() * wheel.center_m;
    wheel.axis = T_root_base_.rotation.conjugate() * wheel.axis;
  }
  ground_m_ = (T_root_base_.inverse() * Eigen::Vector3d(0.0, 0.0, found_.ground_m)).z();
}

bool Normalizer::is_near_ground(double bottom_m) const {
  double max_radius_m = 0.0;
  for (const FoundWheel& wheel : found_.wheels) max_radius_m = std::max(max_radius_m, wheel.radius_m);
  return std::abs(bottom_m - ground_m_) <= 0.02 * max_radius_m + 0.005;
}

/// Decides about endless joints with motors above wheels, and about steering that the option removes.
void Normalizer::choose_carriers() {
  std::size_t num_steered = 0;
  for (FoundWheel& wheel : found_.wheels) {
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
    throw InputError(fmt::format("{}: all {} wheels are steered: not supported: fix the steering joints of one axle",
                                 source_.file, num_steered));
  }
  if (options_.drive == "ackermann" && num_steered == 0) {
    throw InputError(
        fmt::format("{}: drive ackermann: no wheel is below a revolute joint about the vertical", source_.file));
  }
  result_.drive = options_.drive == "mecanum" ? DriveType::kMecanum
                  : num_steered > 0           ? DriveType::kAckermann
                                              : DriveType::kDifferential;
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
  source_.fail(at.line, at.name, "wheels that are not steered are on one side only: both sides must have one");
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
  for (const FoundWheel* wheel : mimicking) {
    if (driven_.insert(wheel->joint).second || wheel->joint->is_mimic)
      assume(wheel->joint->name, "has a motor: its <mimic> follows a driven wheel", "<mimic> of the joint");
  }
  double min_y = std::numeric_limits<double>::infinity(), max_y = -min_y;
  for (const FoundWheel* wheel : candidates) {
    if (!driven_.contains(wheel->joint)) continue;
    min_y = std::min(min_y, wheel->center_m.y());
    max_y = std::max(max_y, wheel->center_m.y());
  }
  if (min_y > 0.0 || max_y < 0.0 || max_y - min_y < 1e-3) {
    const SourceJoint& joint = **driven_.begin();
    source_.fail(joint.line, joint.name, "driven wheels on one side only: both sides must be driven");
  }
  check_fixed_sides(candidates);
}

void Normalizer::report_frozen_joints() {
  std::vector<std::string> names;
  for (const SourceJoint& joint : source_.joints) {
    if (joint.type == JointType::kFixed || kept_.contains(&joint)) continue;
    const bool is_above_base =
        !T_root_link_.contains(joint.child) || (joint.child == base_ && source_.root().name == joint.parent);
    if (is_above_base && joint.type == JointType::kFloating) continue;
    names.push_back(joint.name);
  }
  if (names.empty()) return;
  assume(list_of(names), "fixed at zero: not joints of wheels", "none: other joints are not simulated");
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

std::string Normalizer::add_mesh(const std::string& stem, const Mesh& mesh) {
  const std::string name = unique(used_files_, file_stem(stem), "") + ".obj";
  result_.meshes.emplace_back(name, to_obj(mesh));
  return "meshes/" + name;
}

void Normalizer::add_visuals(const SourceLink& link, const Pose3& T_new_link, NormalizedLink& target) {
  for (const Shape& visual : link.visuals) {
    Shape shape = visual;
    shape.T_link_shape = T_new_link * visual.T_link_shape;
    if (visual.type != ShapeType::kMesh) {
      target.visuals.push_back({.shape = shape, .rgba = visual.rgba});
      continue;
    }
    auto& files = mesh_files_[visual.mesh.get()];
    if (files.empty()) {
      for (const MeshPart& part : *visual.mesh) {
        const std::string file = add_mesh(visual.mesh_name, part.mesh);
        files.emplace_back(file, part.has_color ? std::optional(part.rgba) : std::nullopt);
        if (part.mesh.triangles.size() > kManyTriangles) {
          assume(file,
                 fmt::format("has {} triangles and slows rendering down: at most {} are advised",
                             part.mesh.triangles.size(), kManyTriangles),
                 "<mesh filename> of the visual");
        }
      }
    }
    for (const auto& [file, color] : files)
      target.visuals.push_back({.shape = shape, .mesh_file = file, .rgba = visual.rgba ? visual.rgba : color});
  }
}

void Normalizer::add_collisions(const SourceLink& link, const Pose3& T_new_link, bool from_visuals,
                                NormalizedLink& target) {
  const std::vector<Shape>& shapes = from_visuals ? link.visuals : link.collisions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (!from_visuals && support_shapes_.contains({link.name, i})) continue;
    Shape shape = shapes[i];
    shape.T_link_shape = T_new_link * shape.T_link_shape;
    if (shape.type != ShapeType::kMesh) {
      if (shape.type == ShapeType::kBox && shape.size_m.minCoeff() <= 0.0) continue;
      target.collisions.push_back({.shape = shape});
      continue;
    }
    auto& files = hull_files_[shapes[i].mesh.get()];
    if (files.empty()) {
      const ConvexPieces pieces = convex_pieces(whole_mesh(shape));
      for (const Mesh& piece : pieces.pieces) files.push_back(add_mesh(shape.mesh_name + "_hull", piece));
      assume(
          link.name,
          fmt::format(
              "collision mesh {} is replaced by {} convex piece{}, the hulls of its connected components{}{}",
              shape.mesh_name, pieces.pieces.size(), pieces.pieces.size() == 1 ? "" : "s",
              pieces.num_dropped > 0 ? fmt::format("; {} small or enclosed ones are left out", pieces.num_dropped) : "",
              pieces.num_merged > 0 ? fmt::format("; {} are merged with a neighbor", pieces.num_merged) : ""),
          "<collision> of the link");
    }
    for (const std::string& file : files) target.collisions.push_back({.shape = shape, .mesh_file = file});
  }
}

/// Returns the inertia of solid shapes of one density with a given mass; 0: the density of a link without mass.
Inertial Normalizer::solid_inertial(const std::vector<Shape>& shapes, double mass_kg) const {
  std::vector<std::pair<Pose3, Inertial>> parts;
  double volume_m3 = 0.0;
  for (const Shape& shape : shapes) {
    const SolidProperties solid = solid_of(shape);
    if (solid.volume_m3 <= 0.0) continue;
    volume_m3 += solid.volume_m3;
    parts.push_back(
        {{}, {.mass_kg = solid.volume_m3, .T_link_inertia = translation(solid.center_m), .inertia = solid.inertia}});
  }
  constexpr double kMinMass_kg = 0.01, kMaxMass_kg = 200.0;
  if (parts.empty()) {
    const double mass = mass_kg > 0.0 ? mass_kg : kMinMass_kg;
    return {.mass_kg = mass, .inertia = 0.4 * mass * 0.02 * 0.02 * Eigen::Matrix3d::Identity()};  // sphere of 2 cm
  }
  const double mass = mass_kg > 0.0 ? mass_kg : std::clamp(kDensity_kgpm3 * volume_m3, kMinMass_kg, kMaxMass_kg);
  for (auto& [pose, part] : parts) {
    part.mass_kg *= mass / volume_m3;
    part.inertia *= mass / volume_m3;
  }
  return combine(parts);
}

/// Returns the inertia of a link, with moments that no body has corrected.
std::optional<Inertial> Normalizer::checked_inertial(const SourceLink& link) {
  if (!link.inertial) return std::nullopt;
  if (link.inertial->mass_kg <= 0.0) {
    assume(link.name, "its <inertial> with mass 0 is left out", "<mass> of the link");
    return std::nullopt;
  }
  Inertial inertial = to_inertial(*link.inertial);
  const std::vector<Shape>& shapes = !link.collisions.empty() ? link.collisions : link.visuals;
  SymmetricEigen<3> eigen = symmetric_eigen(inertial.inertia);
  const Inertial solid = solid_inertial(shapes, inertial.mass_kg);
  if (eigen.values[2] < 1e-4 * symmetric_eigen(solid.inertia).values[2]) {
    // Tensor of the shape about the given center of mass.
    inertial.inertia = solid.inertia;
    inertial.T_link_inertia.rotation.setIdentity();
    assume(link.name, "its inertia of nearly zero is replaced by that of its shape", "<inertia> of the link");
    return inertial;
  }
  const double max = eigen.values[2];
  Eigen::Vector3d& moments = eigen.values;
  constexpr double kMinRatio = 1e-3, kMargin = 1.00005;
  if (moments[0] >= kMinRatio * 1e-2 * max && moments[2] <= (moments[0] + moments[1]) * kMargin) return inertial;
  moments[0] = std::max(moments[0], kMinRatio * max);
  moments[2] = std::min(moments[2], moments[0] + moments[1]);
  inertial.inertia = eigen.vectors * moments.asDiagonal() * eigen.vectors.transpose();
  assume(link.name, "its principal moments of inertia are adjusted by up to 1 %: no body has them",
         "<inertia> of the link");
  return inertial;
}

std::vector<const SourceLink*> Normalizer::moving_group(const SourceJoint& joint) const {
  return rigid_group(source_, joint.child, kept_);
}

/// Returns the inertia of links that move as one, in the frame `T_base_new`; that of `fallback` (in this frame) if the
/// links have no mass. `T_adjust` moves the links in the base.
Inertial Normalizer::moving_inertial(const std::vector<const SourceLink*>& links, const Pose3& T_base_new,
                                     const Pose3& T_adjust, const std::vector<Shape>& fallback,
                                     const SourceJoint& joint) {
  std::vector<std::pair<Pose3, Inertial>> parts;
  for (const SourceLink* link : links) {
    if (const auto inertial = checked_inertial(*link))
      parts.push_back({T_base_new.inverse() * (T_adjust * T_base(link->name)), *inertial});
  }
  if (!parts.empty()) return combine(parts);
  const Inertial inertial = solid_inertial(fallback, 0.0);
  assume(joint.child,
         fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shape", inertial.mass_kg,
                     kDensity_kgpm3),
         "<inertial> of the link");
  return inertial;
}

/// Adds base_link and the links that are fixed to it.
void Normalizer::add_chassis() {
  bool has_collision = false;
  double mass_kg = 0.0;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    has_collision = has_collision || !link.collisions.empty();
    if (link.inertial) mass_kg += link.inertial->mass_kg;
  }
  if (!has_collision)
    assume("chassis", "has no <collision>: contact and footprint are those of the visuals", "<collision> of the links");
  std::vector<const SourceLink*> links = {&source_.link(base_)};
  for (const SourceLink& link : source_.links) {
    if (chassis_.contains(link.name) && link.name != base_) links.push_back(&link);
  }
  std::set<std::string> above;  // massless links without shapes above the base
  for (const SourceJoint* joint = source_.parent_joint(base_); joint != nullptr;
       joint = source_.parent_joint(joint->parent)) {
    if (!source_.link(joint->parent).has_shapes() && !source_.link(joint->parent).inertial) above.insert(joint->parent);
  }
  for (const SourceLink* link : links) {
    if (above.contains(link->name)) continue;
    NormalizedLink target{.name = link_name(link->name)};
    const Pose3 T_base_link = T_base(link->name);
    Pose3 T_target_link;
    if (link->name == base_) {
      T_target_link = T_base_link;
    } else {
      const SourceJoint* joint = source_.parent_joint(link->name);
      const std::string name = joint_name(joint != nullptr ? joint->name : link->name + "_joint");
      target.joint = NormalizedJoint{.name = name, .parent = "base_link", .T_parent_link = T_base_link};
    }
    add_visuals(*link, T_target_link, target);
    add_collisions(*link, T_target_link, !has_collision, target);
    if (const auto inertial = checked_inertial(*link)) {
      target.inertial = combine({{T_target_link, *inertial}});
    } else if (mass_kg <= 0.0 && link->has_shapes()) {
      std::vector<Shape> shapes = link->collisions.empty() ? link->visuals : link->collisions;
      for (Shape& shape : shapes) shape.T_link_shape = T_target_link * shape.T_link_shape;
      target.inertial = solid_inertial(shapes, 0.0);
      assume(link->name,
             fmt::format("has no <inertial>: a mass of {:.3g} kg is assumed, {:.0f} kg/m3 in its shapes",
                         target.inertial->mass_kg, kDensity_kgpm3),
             "<inertial> of the link");
    } else if (link->has_shapes() && !link->inertial) {
      massless_.push_back(link->name);
    }
    result_.links.push_back(std::move(target));
  }
  if (!massless_.empty()) {
    assume(list_of(massless_), "have no <inertial>: massless, since other links of the chassis have masses",
           "<inertial> of the links");
  }
  if (base().inertial) return;
  // A free body needs a mass of its own: the heaviest fixed link gives it.
  NormalizedLink* heaviest = nullptr;
  for (NormalizedLink& link : result_.links) {
    if (link.inertial && (heaviest == nullptr || link.inertial->mass_kg > heaviest->inertial->mass_kg))
      heaviest = &link;
  }
  if (heaviest == nullptr) {
    source_.fail(source_.link(base_).line, base_, "the chassis has neither mass nor shapes");
  }
  base().inertial = combine({{heaviest->joint->T_parent_link, *heaviest->inertial}});
  heaviest->inertial.reset();
}

double Normalizer::total_mass_kg() const {
  double mass_kg = 0.0;
  for (const NormalizedLink& link : result_.links) {
    if (link.inertial) mass_kg += link.inertial->mass_kg;
  }
  return mass_kg;
}

Motor Normalizer::motor_of(const FoundWheel& wheel, std::size_t num_driven, double mass_kg) {
  Motor motor{.effort_nm = wheel.joint->effort.value_or(0.0), .velocity_radps = wheel.joint->velocity.value_or(0.0)};
  const double traction_nm = kFriction * mass_kg * kGravity * wheel.radius_m / static_cast<double>(num_driven);
  if (motor.effort_nm <= 0.0) {
    motor.effort_nm = traction_nm;
    assume(wheel.joint->name,
           fmt::format("torque limit {:.3g} N m: friction {} on all driven wheels", motor.effort_nm, kFriction),
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
    result_.links.push_back(std::move(target));
  }
  result_.max_speed_mps = max_speed_mps;
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
  bool needs_support = max_x - min_x < 0.1 * gauge_m;
  const auto find = [&](bool with_any_shape) {
    for (const std::string& name : chassis_) {
      const SourceLink& link = source_.link(name);
      const bool is_leaf = name != base_;
      const auto consider = [&](const std::vector<Shape>& shapes, bool is_collision) {
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          const Shape& shape = shapes[i];
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
  for (const Support& support : supports_) {
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
  if (mass_kg < wanted_kg) {
    Inertial& inertial = *base().inertial;
    const double taken_kg = std::min(wanted_kg - mass_kg, 0.2 * inertial.mass_kg);
    inertial.inertia *= 1.0 - taken_kg / inertial.mass_kg;
    inertial.mass_kg -= taken_kg;
    mass_kg += taken_kg;
  }
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

void Normalizer::add_frame(const std::string& frame, const Pose3& T_base_frame, const std::string& link) {
  result_.sensor_frames.push_back(frame);
  NormalizedLink target{.name = frame};
  target.joint = NormalizedJoint{
      .name = unique(used_joints_, frame + "_joint", "_frame"), .parent = "base_link", .T_parent_link = T_base_frame};
  result_.links.push_back(std::move(target));
  if (!link.empty()) assume(frame, fmt::format("is the frame of {}", link), fmt::format("--frame {}=LINK", frame));
}

void Normalizer::add_sensors() {
  std::map<std::string, std::vector<std::string>> others;
  std::set<std::string> added;
  for (const auto& [frame, link] : options_.frames) {
    if (!chassis_.contains(link))
      source_.fail(source_.link(link).line, link, fmt::format("frame {}: must be on the chassis", frame));
    add_frame(frame, T_base(link), "");
    added.insert(frame);
  }
  for (const SourceSensor& sensor : source_.sensors) {
    if (!chassis_.contains(sensor.link)) {
      assume(sensor.link, fmt::format("its sensor of type {} is on a moving part and left out", sensor.frame),
             fmt::format("--frame {}=LINK", sensor.frame));
      continue;
    }
    if (!added.insert(sensor.frame).second) {
      if (!options_.frames.contains(sensor.frame)) others[sensor.frame].push_back(sensor.link);
      continue;
    }
    add_frame(sensor.frame, T_base(sensor.link) * sensor.T_link_sensor, sensor.link);
  }
  for (const auto& [frame, links] : others)
    assume(frame, fmt::format("further sensors of this type are left out: {}", list_of(links)),
           fmt::format("--frame {}=LINK", frame));
  if (!added.contains("imu")) {
    std::vector<std::pair<Pose3, Inertial>> parts;
    for (const NormalizedLink& link : result_.links) {
      const bool is_fixed = !link.joint || link.joint->is_fixed;
      if (link.inertial && is_fixed)
        parts.push_back({link.joint ? link.joint->T_parent_link : Pose3{}, *link.inertial});
    }
    add_frame("imu", translation(combine(parts).T_link_inertia.position), "");
    assume("imu", "is at the center of mass of the chassis: the file has none", "--frame imu=LINK");
  }
  if (!added.contains("lidar") && !added.contains("lidar3d"))
    assume("lidar", "the robot has none: the file has no sensor of type ray or lidar", "--frame lidar=LINK");
}

/// Reports a center of mass that is not between the contacts with the ground.
void Normalizer::check_balance() {
  std::map<std::string, Pose3> T_base_new;
  std::vector<std::pair<Pose3, Inertial>> parts;
  std::vector<Eigen::Vector2d> contacts;
  for (const NormalizedLink& link : result_.links) {
    T_base_new[link.name] = link.joint ? T_base_new.at(link.joint->parent) * link.joint->T_parent_link : Pose3{};
    if (link.inertial) parts.push_back({T_base_new.at(link.name), *link.inertial});
    const bool is_wheel = link.joint && !link.joint->is_fixed && std::abs(link.joint->axis.y()) > 0.5;
    if (is_wheel) contacts.push_back(T_base_new.at(link.name).position.head<2>());
  }
  const Eigen::Vector2d center = combine(parts).T_link_inertia.position.head<2>();
  const ConvexPolygon polygon = patrol::convex_hull(contacts);
  double margin_m = polygon.size() < 3 ? 0.0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size() && polygon.size() >= 3; ++i) {
    const Eigen::Vector2d side = (polygon[(i + 1) % polygon.size()] - polygon[i]).normalized(),
                          to = center - polygon[i];
    margin_m = std::min(margin_m, side.x() * to.y() - side.y() * to.x());
  }
  if (margin_m >= 0.01) return;
  assume("center of mass",
         fmt::format(
             "is at x = {:.3f}, y = {:.3f} m in base_link, {:.3f} m {} the area between the contacts of the wheels: "
             "the robot {}",
             center.x(), center.y(), std::abs(margin_m), margin_m < 0.0 ? "outside" : "inside the edge of",
             margin_m < 0.0 ? "tips over" : "tips when it brakes"),
         "<inertial> of the links");
}

/// Reports a part of the chassis that touches the ground.
void Normalizer::check_clearance() {
  constexpr double kMinClearance_m = 0.005;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    double lowest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < link.collisions.size(); ++i) {
      if (support_shapes_.contains({name, i})) continue;
      for (const Eigen::Vector3d& point : outline(link.collisions[i]))
        lowest_m = std::min(lowest_m, (T_base(name) * point).z() - ground_m_);
    }
    if (lowest_m >= kMinClearance_m) continue;
    assume(name,
           fmt::format("its collision shape is {:.3f} m {} the ground: it drags", std::abs(lowest_m),
                       lowest_m < 0.0 ? "below" : "above"),
           "<collision> of the link");
  }
}

/// Joins assumptions that differ in the subject only.
std::vector<Assumption> joined(const std::vector<Assumption>& assumptions) {
  std::vector<Assumption> rows;
  for (const Assumption& next : assumptions) {
    const auto same = std::find_if(rows.begin(), rows.end(), [&next](const Assumption& row) {
      return row.text == next.text && row.override_with == next.override_with;
    });
    if (same == rows.end()) rows.push_back(next);
    else if (same->subject != next.subject) same->subject += ", " + next.subject;
  }
  return rows;
}

/// Computes the length and the turning radius, for the settings.
void Normalizer::finish() {
  check_balance();
  check_clearance();
  result_.assumptions = joined(result_.assumptions);
  double front_m = -std::numeric_limits<double>::infinity(), rear_m = -front_m;
  for (const std::string& name : chassis_) {
    const SourceLink& link = source_.link(name);
    for (const Shape& shape : link.collisions.empty() ? link.visuals : link.collisions) {
      for (const Eigen::Vector3d& point : outline(shape)) {
        front_m = std::max(front_m, (T_base(name) * point).x());
        rear_m = std::min(rear_m, (T_base(name) * point).x());
      }
    }
  }
  double fixed_x = 0.0, num_fixed = 0.0, steered_x = 0.0, num_steered = 0.0, max_angle = 0.6;
  for (const FoundWheel& wheel : found_.wheels) {
    front_m = std::max(front_m, wheel.center_m.x() + wheel.radius_m);
    rear_m = std::min(rear_m, wheel.center_m.x() - wheel.radius_m);
    if (wheel.carrier_type == CarrierType::kSteering) {
      steered_x += wheel.center_m.x();
      ++num_steered;
      if (!wheel.carrier->is_endless())
        max_angle = std::min(std::abs(wheel.carrier->lower), std::abs(wheel.carrier->upper));
    } else if (wheel.carrier_type == CarrierType::kNone) {
      fixed_x += wheel.center_m.x();
      ++num_fixed;
    }
  }
  result_.length_m = front_m - rear_m;
  if (num_steered > 0.0) {
    const double wheelbase_m = std::abs(steered_x / num_steered - fixed_x / num_fixed);
    result_.min_turning_radius_m = wheelbase_m / std::tan(std::clamp(max_angle, 0.05, 1.5));
  }
}

NormalizedRobot Normalizer::run() {
  check_options();
  found_ = find_wheels(source_);
  for (const Assumption& assumption : found_.assumptions) result_.assumptions.push_back(assumption);
  choose_carriers();
  choose_base();
  choose_frame();
  choose_drive();
  report_frozen_joints();
  reserve_names();
  add_supports();
  add_chassis();
  add_wheels();
  const double mass_kg = total_mass_kg();
  for (const Support& support : supports_) add_support(support, mass_kg);
  add_sensors();
  finish();
  return std::move(result_);
}

}  // namespace

NormalizedRobot normalize(const SourceRobot& source, const NormalizeOptions& options) {
  return Normalizer(source, options).run();
}

}  // namespace patrol::importer
