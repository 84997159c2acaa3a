#include "sim/wheel_model.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace patrol::sim {
namespace {

/// Radius and half width of a wheel's collision shape.
struct Tread {
  double radius_m;
  double half_width_m;
};

Tread tread_of(const urdf::Link& wheel) {
  const urdf::Geometry* shape = wheel.collision ? wheel.collision->geometry.get() : nullptr;
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(shape))
    return {.radius_m = cylinder->radius, .half_width_m = 0.5 * cylinder->length};
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(shape))
    return {.radius_m = sphere->radius, .half_width_m = sphere->radius};
  throw InputError(wheel.name + ": the collision shape of a wheel must be a cylinder or a sphere");
}

Pose3 to_pose(const urdf::Pose& pose) {
  return {{pose.position.x, pose.position.y, pose.position.z},
          Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z)};
}

/// Returns the pose of a link in the root with all joints at zero.
Pose3 T_root_link(const urdf::Link& link) {
  if (!link.parent_joint) return {};
  return T_root_link(*link.getParent()) * to_pose(link.parent_joint->parent_to_joint_origin_transform);
}

}  // namespace

bool is_wheel(const urdf::Link& link) {
  return link.parent_joint && link.parent_joint->type == urdf::Joint::CONTINUOUS && link.child_links.empty();
}

bool has_wheels(const urdf::ModelInterface& robot) {
  return std::any_of(robot.links_.begin(), robot.links_.end(),
                     [](const auto& entry) { return is_wheel(*entry.second); });
}

void add_rolling_shape(const urdf::Link& wheel, mjsBody& body) {
  const Tread tread = tread_of(wheel);
  mjsGeom* geom = mjs_addGeom(&body, nullptr);
  mjs_setName(geom->element, wheel.name.c_str());
  const Pose3 T_link_shape = to_pose(wheel.collision->origin);
  std::copy_n(T_link_shape.position.data(), 3, geom->pos);
  const double quaternion[4] = {T_link_shape.rotation.w(), T_link_shape.rotation.x(), T_link_shape.rotation.y(),
                                T_link_shape.rotation.z()};
  std::copy_n(quaternion, 4, geom->quat);
  geom->type = mjGEOM_ELLIPSOID;
  geom->size[0] = geom->size[1] = tread.radius_m;
  geom->size[2] = tread.half_width_m;
  geom->contype = kRobotContype;
  geom->conaffinity = kRobotConaffinity;
  geom->group = kGroupRobotCollision;
  geom->condim = 3;
  geom->priority = 1;
}

void use_wheel_friction(mjOption& option) {
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = 1.0;
}

Stance stance_on_wheels(const urdf::ModelInterface& robot) {
  constexpr double kDrop_m = 0.005;
  Stance stance{
      .height_m = 0.0, .support_points_m = {Eigen::Vector2d::Zero()}, .feet_m = {}, .max_ground_height_m = 1.0};
  for (const auto& [name, link] : robot.links_) {
    if (!is_wheel(*link)) continue;
    const Eigen::Vector3d center = T_root_link(*link) * to_pose(link->collision->origin).position;
    stance.height_m = std::max(stance.height_m, tread_of(*link).radius_m - center.z() + kDrop_m);
    stance.support_points_m.push_back(center.head<2>());
  }
  return stance;
}

}  // namespace patrol::sim
