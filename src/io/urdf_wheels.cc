#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "core/geometry/convex_polygon.h"
#include "core/wheel_kinematics.h"
#include "io/urdf_reader.h"

namespace patrol::io {
namespace {

constexpr double kParallelCosine = 0.999;  // axes within 2.6 degrees are parallel

bool turns_endlessly(const urdf::Link& link) {
  return link.parent_joint && link.parent_joint->type == urdf::Joint::CONTINUOUS;
}

/// Returns the vector of a joint's axis in body with all joints at zero.
Eigen::Vector3d axis_in_body(const urdf::Joint& joint, const Pose3& T_body_child) {
  return T_body_child.rotation * Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z).stableNormalized();
}

}  // namespace

bool UrdfReader::has_wheels() const {
  return std::any_of(model_->links_.begin(), model_->links_.end(),
                     [](const auto& entry) { return turns_endlessly(*entry.second); });
}

/// Returns the pose of a link in body with all joints at zero.
Pose3 UrdfReader::T_body_link(const urdf::Link& link) const {
  if (link.name == frame_id::kBody) return {};
  const urdf::LinkConstSharedPtr parent = link.getParent();
  if (!parent) fail(link.name, fmt::format("is not connected to {}", frame_id::kBody));
  const Pose3 T_parent_link = to_pose(link.parent_joint->parent_to_joint_origin_transform);
  return parent->name == frame_id::kBody ? T_parent_link : T_body_link(*parent) * T_parent_link;
}

/// Reads the shape of a wheel: a cylinder about the axis of its joint, or a sphere.
WheelGeometry UrdfReader::read_wheel_shape(const urdf::Link& link) const {
  const Pose3 T_body_wheel = T_body_link(link);
  const Eigen::Vector3d axis = axis_in_body(*link.parent_joint, T_body_wheel);
  if (std::abs(axis.y()) < kParallelCosine)
    fail(link.parent_joint->name, fmt::format("the axis of a wheel must be along y of {}", frame_id::kBody));
  if (link.collision_array.size() != 1)
    fail(link.name, "a wheel must have one collision shape: a cylinder or a sphere");
  const urdf::Collision& shape = *link.collision_array.front();
  const Pose3 T_body_shape = T_body_wheel * to_pose(shape.origin);
  WheelGeometry wheel{
      .link = link.name, .center_in_body = T_body_shape.position, .forward_sign = axis.y() > 0.0 ? 1.0 : -1.0};
  if (shape.geometry->type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*shape.geometry);
    if (std::abs((T_body_shape.rotation * Eigen::Vector3d::UnitZ()).dot(axis)) < kParallelCosine)
      fail(link.name, "the collision cylinder of a wheel must be about the axis of its joint");
    wheel.radius_m = cylinder.radius;
    wheel.width_m = cylinder.length;
  } else if (shape.geometry->type == urdf::Geometry::SPHERE) {
    wheel.radius_m = dynamic_cast<const urdf::Sphere&>(*shape.geometry).radius;
    wheel.width_m = 2.0 * wheel.radius_m;
  } else {
    fail(link.name, "the collision shape of a wheel must be a cylinder or a sphere");
  }
  return wheel;
}

namespace {

/// Returns the joint that turns the carrier of a wheel; null for a wheel on the chassis.
urdf::JointConstSharedPtr carrier_joint(const urdf::Link& wheel) {
  for (urdf::LinkConstSharedPtr at = wheel.getParent(); at && at->parent_joint; at = at->getParent()) {
    if (at->parent_joint->type != urdf::Joint::FIXED) return at->parent_joint;
  }
  return nullptr;
}

}  // namespace

std::size_t UrdfReader::add_joint(const std::string& name, RobotDescription& robot) const {
  robot.joint_names.push_back(name);
  robot.joint_limits.push_back(read_limit(name));
  return robot.joint_names.size() - 1;
}

/// Reads the wheels: links without children on continuous joints. A motor drives a wheel whose joint has a <limit>. A
/// wheel is steered if a joint with a <limit> turns its carrier, and a caster if a joint without <limit> does.
void UrdfReader::read_wheels(RobotDescription& robot) const {
  std::vector<urdf::JointConstSharedPtr> carrier_joints;  // [wheel]
  for (const auto& [name, link] : model_->links_) {
    if (!turns_endlessly(*link) || !link->child_links.empty()) continue;
    robot.wheels.push_back(read_wheel_shape(*link));
    if (link->parent_joint->limits) robot.wheels.back().drive_joint = add_joint(link->parent_joint->name, robot);
    carrier_joints.push_back(carrier_joint(*link));
  }
  for (std::size_t i = 0; i < robot.wheels.size(); ++i) {
    if (!carrier_joints[i]) continue;
    const urdf::Joint& carrier = *carrier_joints[i];
    const double up = axis_in_body(carrier, T_body_link(*model_->getLink(carrier.child_link_name))).z();
    if (std::abs(up) < kParallelCosine)
      fail(carrier.name, fmt::format("the joint above a wheel must turn about z of {}", frame_id::kBody));
    robot.wheels[i].is_caster = !carrier.limits;
    if (!carrier.limits) continue;
    if (std::find(robot.joint_names.begin(), robot.joint_names.end(), carrier.name) != robot.joint_names.end())
      fail(carrier.name, "steers several wheels: each steered wheel must have a joint of its own");
    robot.wheels[i].left_sign = up > 0.0 ? 1.0 : -1.0;
    robot.wheels[i].steering_joint = add_joint(carrier.name, robot);
  }
  check_wheels(robot);
  robot.center_of_mass_x_m = 0.0;
  for (const auto& [name, link] : model_->links_) {
    if (!link->inertial) continue;
    const Pose3 T_body_part = T_body_link(*link) * to_pose(link->inertial->origin);
    *robot.center_of_mass_x_m += link->inertial->mass / robot.mass_kg * T_body_part.position.x();
  }
}

void UrdfReader::check_wheels(const RobotDescription& robot) const {
  constexpr double kLevel_m = 0.01;
  const double height_m = robot.body_height_m();
  bool is_driven = false;
  for (const WheelGeometry& wheel : robot.wheels) {
    is_driven = is_driven || wheel.drive_joint;
    const double above_m = height_m + wheel.center_in_body.z() - wheel.radius_m;
    if (above_m <= kLevel_m) continue;
    fail(wheel.link, fmt::format("is {:.3f} m above the lowest wheel: all wheels must touch one plane", above_m));
  }
  if (!is_driven)
    throw InputError(path_ +
                     ": no wheel has a motor: the joint of a driven wheel has a <limit> with effort and velocity");
  try {
    differential_geometry(robot);
    wheel_drive_type(robot);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path_, error.what()));
  }
}

/// Reads the vertices of a mesh. Only Wavefront OBJ, without scale.
std::vector<Eigen::Vector3d> UrdfReader::read_vertices(const urdf::Mesh& mesh) const {
  const std::filesystem::path file = std::filesystem::path(path_).parent_path() / mesh.filename;
  const bool is_scaled = mesh.scale.x != 1.0 || mesh.scale.y != 1.0 || mesh.scale.z != 1.0;
  if (file.extension() != ".obj" || is_scaled)
    fail(mesh.filename, "a mesh must be an OBJ file in meters without scale (patrol import robot converts others)");
  std::vector<Eigen::Vector3d> vertices;
  std::istringstream lines(load_text(file.string()));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    Eigen::Vector3d p;
    if (words >> kind && kind == "v" && words >> p.x() >> p.y() >> p.z()) vertices.push_back(p);
  }
  return vertices;
}

/// Returns points on the outline of a shape, seen along any axis, in its frame.
std::vector<Eigen::Vector3d> UrdfReader::outline_points(const urdf::Geometry& geometry) const {
  if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&geometry)) return read_vertices(*mesh);
  std::vector<Eigen::Vector3d> points;
  constexpr int kNumOnCircle = 16;
  const auto add_circle = [&points](double radius_m, double z_m) {
    for (int i = 0; i < kNumOnCircle; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kNumOnCircle;
      points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), z_m);
    }
  };
  if (geometry.type == urdf::Geometry::BOX) {
    const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) points.emplace_back(x * size.x, y * size.y, z * size.z);
      }
    }
  } else if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
    for (const double end : {-0.5, 0.5}) add_circle(cylinder.radius, end * cylinder.length);
  } else if (geometry.type == urdf::Geometry::SPHERE) {
    add_circle(dynamic_cast<const urdf::Sphere&>(geometry).radius, 0.0);
  }
  return points;
}

/// Appends the outlines of the collision shapes of a link, seen from above.
void UrdfReader::add_outline(const urdf::Link& link, const Pose3& T_body_link,
                             std::vector<Eigen::Vector2d>& points) const {
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    Pose3 T_body_shape = T_body_link * to_pose(collision->origin);
    if (collision->geometry->type == urdf::Geometry::SPHERE) T_body_shape.rotation.setIdentity();
    for (const Eigen::Vector3d& point : outline_points(*collision->geometry))
      points.emplace_back((T_body_shape * point).head<2>());
  }
}

/// Returns all collision shapes seen from above.
std::vector<Eigen::Vector2d> UrdfReader::read_wheeled_footprint() const {
  std::vector<Eigen::Vector2d> points;
  for (const auto& [name, link] : model_->links_) add_outline(*link, T_body_link(*link), points);
  return convex_hull(std::move(points));
}

}  // namespace patrol::io
