#include "io/urdf.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "core/error.h"
#include "core/geometry/convex_polygon.h"
#include "core/geometry/linear_algebra.h"
#include "io/urdf_reader.h"

namespace patrol::io {
namespace {

constexpr std::array kSideNames = {"left", "right"};
constexpr std::array kTrackNames = {"left_track", "right_track"};
constexpr std::string_view kSpaces = " \t\n\v\f\r";
constexpr std::array<std::string_view, 11> kNumberNames = {"xyz",   "rpy",   "size",  "scale",  "radius",  "length",
                                                           "value", "lower", "upper", "effort", "velocity"};

/// Returns whether all words are finite numbers.
bool are_numbers(const std::string& words_text) {
  std::istringstream words(words_text);
  for (std::string word; words >> word;) {
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const end = word.data() + word.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value)) return false;
  }
  return true;
}

/// Length of the name of an attribute of numbers at the end of `text`; 0 if there is none.
std::size_t length_of_number_name(std::string_view text) {
  for (const std::string_view name : kNumberNames) {
    if (text.ends_with(name)) return name.size();
  }
  const auto is_axis = [](char c) { return c >= 'x' && c <= 'z'; };
  const std::string_view inertia = text.substr(text.size() - std::min<std::size_t>(3, text.size()));
  return inertia.size() == 3 && inertia[0] == 'i' && is_axis(inertia[1]) && is_axis(inertia[2]) ? 3 : 0;
}

}  // namespace

/// Rejects numbers that are not finite, in the text of the file. urdfdom accepts "nan" and reports "inf" without a
/// position.
void UrdfReader::check_numbers() const {
  for (std::size_t equals = text_.find('='); equals != std::string::npos; equals = text_.find('=', equals + 1)) {
    const std::size_t name_end = text_.find_last_not_of(kSpaces, equals == 0 ? 0 : equals - 1) + 1;
    const std::size_t quote = text_.find_first_not_of(kSpaces, equals + 1);
    const std::size_t length = length_of_number_name(std::string_view(text_).substr(0, std::min(name_end, equals)));
    if (length == 0 || quote == std::string::npos || text_[quote] != '"') continue;
    const std::size_t end = text_.find('"', quote + 1);
    if (end == std::string::npos || are_numbers(text_.substr(quote + 1, end - quote - 1))) continue;
    const std::size_t begin = name_end - length;
    const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
    throw input_error(path_, static_cast<int>(line),
                      fmt::format("{}: must be finite numbers", text_.substr(begin, end + 1 - begin)));
  }
}

/// Reports every joint with a missing parent or child link; the message of urdfdom does not name them.
void UrdfReader::check_links() const {
  const auto name_after = [this](std::size_t begin) { return text_.substr(begin, text_.find('"', begin) - begin); };
  std::set<std::string> links;
  const std::string link_opening = "<link name=\"";
  for (std::size_t at = text_.find(link_opening); at != std::string::npos; at = text_.find(link_opening, at + 1))
    links.insert(name_after(at + link_opening.size()));
  for (const std::string tag : {"parent", "child"}) {
    const std::string opening = "<" + tag + " link=\"";
    for (std::size_t at = text_.find(opening); at != std::string::npos; at = text_.find(opening, at + 1)) {
      const std::string link = name_after(at + opening.size());
      if (!links.contains(link)) fail(link, "unknown link: " + tag + " of a joint");
    }
  }
}

namespace {

/// Captures the messages of urdfdom during its lifetime.
class ParserErrors : public console_bridge::OutputHandler {
 public:
  ParserErrors() { console_bridge::useOutputHandler(this); }
  ~ParserErrors() override { console_bridge::restorePreviousOutputHandler(); }
  ParserErrors(const ParserErrors&) = delete;
  ParserErrors& operator=(const ParserErrors&) = delete;
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

}  // namespace

void UrdfReader::parse() {
  ParserErrors errors;
  model_ = urdf::parseURDF(text_);
  if (!errors.first().empty()) throw InputError(fmt::format("{}: not a valid URDF file: {}", path_, errors.first()));
  if (!model_) throw InputError(path_ + ": not a valid URDF file (see check_urdf)");
}

/// Rejects links with two parents and cycles of joints, both of which urdfdom accepts.
void UrdfReader::check_tree() const {
  std::map<std::string, std::string> parent_of;  // child link to parent link
  for (const auto& [name, joint] : model_->joints_) {
    if (!parent_of.emplace(joint->child_link_name, joint->parent_link_name).second) {
      fail(joint->child_link_name, "child of two joints: only one is allowed");
    }
  }
  for (const auto& [name, link] : model_->links_) {
    std::size_t steps = 0;
    for (auto at = parent_of.find(name); at != parent_of.end(); at = parent_of.find(at->second)) {
      if (++steps <= parent_of.size()) continue;
      // Break the shared-pointer cycle, which would leak.
      for (const auto& [ignored, held] : model_->links_) held->child_links.clear();
      fail(name, "the joints form a cycle");
    }
  }
}

/// Checks that principal moments of inertia are positive and satisfy the triangle inequality.
void UrdfReader::check_inertias() const {
  for (const auto& [name, link] : model_->links_) {
    if (!link->inertial) continue;
    const urdf::Inertial& i = *link->inertial;
    Eigen::Matrix3d inertia;
    inertia << i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz;
    const Eigen::Vector3d moments = symmetric_eigen(inertia).values;
    constexpr double kRounding = 1e-4;  // files have few digits
    if (moments[0] > 0.0 && moments[2] <= (moments[0] + moments[1]) * (1.0 + kRounding)) continue;
    fail(name, fmt::format("invalid inertia: principal moments {:.3g}, {:.3g} and {:.3g} kg m2", moments[0], moments[1],
                           moments[2]));
  }
}

urdf::JointConstSharedPtr UrdfReader::joint(const std::string& name) const {
  urdf::JointConstSharedPtr found = model_->getJoint(name);
  if (!found) throw InputError(fmt::format("{}: joint not found: {}", path_, name));
  return found;
}

Pose3 UrdfReader::joint_origin(const std::string& name) const {
  return to_pose(joint(name)->parent_to_joint_origin_transform);
}

double UrdfReader::sprocket_radius_m(const std::string& link) const {
  const urdf::LinkConstSharedPtr sprocket = model_->getLink(link);
  if (!sprocket || !sprocket->collision || sprocket->collision->geometry->type != urdf::Geometry::CYLINDER) {
    fail(link, "collision shape of a sprocket must be a cylinder");
  }
  return std::static_pointer_cast<const urdf::Cylinder>(sprocket->collision->geometry)->radius;
}

std::vector<TrackWheel> UrdfReader::read_track_wheels(const std::string& track) const {
  const urdf::LinkConstSharedPtr link = model_->getLink(track);
  if (!link || !link->parent_joint || link->parent_joint->type != urdf::Joint::FIXED ||
      link->parent_joint->parent_link_name != frame_id::kBody) {
    fail(track, fmt::format("a track must be fixed to {}", frame_id::kBody));
  }
  const Pose3 T_body_track = to_pose(link->parent_joint->parent_to_joint_origin_transform);
  std::vector<TrackWheel> wheels;
  for (const urdf::CollisionSharedPtr& collision : link->collision_array) {
    const Pose3 T_body_wheel = T_body_track * to_pose(collision->origin);
    const bool is_across = std::abs((T_body_wheel.rotation * Eigen::Vector3d::UnitZ()).y()) > 0.9999;
    if (collision->geometry->type != urdf::Geometry::CYLINDER || !is_across) {
      fail(track, "collision shapes of a track must be its wheels: cylinders along y");
    }
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*collision->geometry);
    wheels.push_back({.center_m = T_body_wheel.position, .radius_m = cylinder.radius, .width_m = cylinder.length});
  }
  return wheels;
}

JointLimit UrdfReader::read_limit(const std::string& name) const {
  const urdf::JointLimitsSharedPtr limits = joint(name)->limits;
  if (!limits) fail(name, "<limit> is missing");
  const bool is_endless = joint(name)->type == urdf::Joint::CONTINUOUS;
  const double upper = is_endless ? std::numeric_limits<double>::infinity() : limits->upper;
  const double lower = is_endless ? -upper : limits->lower;
  if (lower >= upper) fail(name, fmt::format("limit lower = {}: must be below upper = {}", lower, upper));
  if (limits->effort <= 0.0 || limits->velocity <= 0.0) fail(name, "limit effort and velocity must be positive");
  return {.lower_rad = lower, .upper_rad = upper, .velocity_radps = limits->velocity, .effort_nm = limits->effort};
}

namespace {

/// Returns the height of the contact with level ground in body.
double underside_m(const std::vector<TrackWheel>& wheels) {
  double bottom = std::numeric_limits<double>::infinity();
  for (const TrackWheel& wheel : wheels) bottom = std::min(bottom, wheel.center_m.z() - wheel.radius_m);
  return bottom;
}

/// Returns the distance between the first and the last road wheel. Road wheels are the lowest wheels, between which the
/// belt is on the ground.
double contact_length_m(const std::vector<TrackWheel>& wheels) {
  constexpr double kLevel_m = 1e-3;
  const double bottom = underside_m(wheels);
  double front = -std::numeric_limits<double>::infinity(), rear = -front;
  for (const TrackWheel& wheel : wheels) {
    if (wheel.center_m.z() - wheel.radius_m > bottom + kLevel_m) continue;
    front = std::max(front, wheel.center_m.x());
    rear = std::min(rear, wheel.center_m.x());
  }
  return front - rear;
}

}  // namespace

/// Returns the footprint of a tracked robot: the box of the body and the tracks, seen from above.
std::vector<Eigen::Vector2d> UrdfReader::read_tracked_footprint() const {
  std::vector<Eigen::Vector2d> points;
  const urdf::LinkConstSharedPtr base = model_->getLink(frame_id::kBody);
  if (base && base->collision && base->collision->geometry->type == urdf::Geometry::BOX) {
    const urdf::Vector3& size = std::static_pointer_cast<const urdf::Box>(base->collision->geometry)->dim;
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) points.emplace_back(x * size.x, y * size.y);
    }
  }
  for (const char* track : kTrackNames) {
    for (const TrackWheel& wheel : read_track_wheels(track)) {
      for (const double x : {-wheel.radius_m, wheel.radius_m}) {
        for (const double y : {-0.5, 0.5})
          points.emplace_back(wheel.center_m.head<2>() + Eigen::Vector2d(x, y * wheel.width_m));
      }
    }
  }
  return convex_hull(std::move(points));
}

void UrdfReader::read_tracks(RobotDescription& robot) const {
  const std::vector<TrackWheel> left = read_track_wheels(kTrackNames[0]), right = read_track_wheels(kTrackNames[1]);
  if (left.size() < 2 || left.size() != right.size())
    fail(kTrackNames[0], "must have at least two wheels, as many as the other track");
  for (const char* side : kSideNames) {
    robot.joint_names.push_back(side + std::string("_sprocket_joint"));
    robot.joint_limits.push_back(read_limit(robot.joint_names.back()));
  }
  robot.tracks = TrackGeometry{.gauge_m = left.front().center_m.y() - right.front().center_m.y(),
                               .width_m = left.front().width_m,
                               .contact_length_m = contact_length_m(left),
                               .sprocket_radius_m = sprocket_radius_m("left_sprocket"),
                               .body_height_m = -underside_m(left)};
  if (robot.tracks->gauge_m <= robot.tracks->width_m) fail(kTrackNames[0], "must be to the left of the right track");
  if (robot.tracks->contact_length_m <= 0.0) fail(kTrackNames[0], "at least two wheels must touch the ground");
}

namespace {

/// Returns whether only fixed joints connect a link, other than the body itself, to the body.
bool is_fixed_to_body(const urdf::Link& link) {
  if (!link.parent_joint || link.parent_joint->type != urdf::Joint::FIXED) return false;
  return link.parent_joint->parent_link_name == frame_id::kBody || is_fixed_to_body(*link.getParent());
}

}  // namespace

AntennaGeometry UrdfReader::read_antenna() const {
  const auto check = [this](const char* name, const Eigen::Vector3d& axis) {
    const urdf::JointConstSharedPtr found = joint(name);
    const Eigen::Vector3d found_axis(found->axis.x, found->axis.y, found->axis.z);
    if (found->type != urdf::Joint::REVOLUTE || (found_axis - axis).norm() > 1e-9)
      fail(name, "must be revolute, yaw about z, pitch about y");
    const Pose3 origin = joint_origin(name);
    if (origin.position.norm() > 1e-9 || origin.rotation.vec().norm() > 1e-9)
      fail(name, "must have no <origin>: the axes of the antenna intersect in the center of the coil");
  };
  check("tem_yaw_joint", Eigen::Vector3d::UnitZ());
  check("tem_pitch_joint", Eigen::Vector3d::UnitY());
  AntennaGeometry mount{.T_body_mount = joint_origin("tem_mount_joint"),
                        .yaw = read_limit("tem_yaw_joint"),
                        .pitch = read_limit("tem_pitch_joint")};
  if (mount.pitch.lower_rad >= mount.stowed_pitch_rad)
    fail("tem_pitch_joint", "lower limit must reach -90 degrees, the stowed pitch");
  return mount;
}

RobotDescription UrdfReader::read() const {
  RobotDescription robot;
  robot.name = model_->getName();
  for (const auto& [name, link] : model_->links_) {
    if (link->inertial) robot.mass_kg += link->inertial->mass;
    if (link->inertial && link->inertial->mass <= 0.0) fail(name, "mass must be positive");
    const bool moves = link->parent_joint && link->parent_joint->type != urdf::Joint::FIXED;
    if (moves && !link->inertial) fail(name, "<inertial> is missing: required for a moving link");
    if (is_fixed_to_body(*link)) robot.T_body_sensor[name] = T_body_link(*link);
  }
  if (!model_->getLink(frame_id::kBody))
    throw InputError(fmt::format("{}: link not found: {}", path_, frame_id::kBody));
  if (model_->getLink(kTrackNames[0])) {
    read_tracks(robot);
    robot.footprint_m = read_tracked_footprint();
  } else if (has_wheels() && !has_legs()) {
    read_wheels(robot);
    robot.footprint_m = read_wheeled_footprint();
  } else {
    read_legs(robot);
    read_standing_inertia(robot);
    robot.footprint_m = read_legged_footprint(robot);
  }
  if (model_->getLink("tem_mount")) robot.antenna = read_antenna();
  return robot;
}

RobotDescription load_robot_description(const std::string& path) { return UrdfReader(path).read(); }

}  // namespace patrol::io
