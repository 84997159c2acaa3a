#include "sim/robot_model.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/leg_kinematics.h"
#include "sim/leg_scale.h"
#include "sim/track_model.h"
#include "sim/wheel_model.h"

namespace patrol::sim {
namespace {

// Leg joints: reflected rotor inertia typical of motors of 23.7 N m, friction of a good bearing. Tuned so that the
// passive leg swings like the damping in the public robot description. Others are proportional to `motor_ratio`.
constexpr double kArmature = 0.01;
constexpr double kDamping = 0.1;
constexpr double kFrictionLoss = 0.2;

// Rubber foot on asphalt: time constant of 6 ms; the friction of the foot applies on any ground.
constexpr double kFootFriction = 0.8;
// Slender cylinders, half as long as two radii or more, are capsules: these collide faster and more smoothly. Their
// ends reach beyond those of the cylinder by its radius.
constexpr double kSlender = 2.0;

void set_pose(const urdf::Pose& pose, double position[3], double quaternion[4]) {
  position[0] = pose.position.x;
  position[1] = pose.position.y;
  position[2] = pose.position.z;
  quaternion[0] = pose.rotation.w;
  quaternion[1] = pose.rotation.x;
  quaternion[2] = pose.rotation.y;
  quaternion[3] = pose.rotation.z;
}

/// Properties of the whole robot that its links need.
struct RobotParts {
  const RobotDescription& description;
  std::filesystem::path folder;  ///< folder of the URDF file and its meshes
  bool is_tracked;
  double road_wheel_load_n;  ///< load of each road wheel, if the robot has any
};

/// Adds the mesh of a file once and returns its name.
std::string add_mesh(const urdf::Mesh& mesh, const RobotParts& robot, mjSpec& spec) {
  const std::filesystem::path file = robot.folder / mesh.filename;
  if (file.extension() != ".obj")
    throw InputError(fmt::format("robot URDF: mesh {}: must be an OBJ file (patrol import robot)", mesh.filename));
  std::string name = "robot/" + mesh.filename;
  if (mjs_findElement(&spec, mjOBJ_MESH, name.c_str()) != nullptr) return name;
  mjsMesh* asset = mjs_addMesh(&spec, nullptr);
  mjs_setName(asset->element, name.c_str());
  mjs_setString(asset->file, std::filesystem::absolute(file).c_str());
  asset->inertia = mjMESH_INERTIA_SHELL;  // thin meshes have no volume; inertias are those of the URDF
  return name;
}

void set_shape(const urdf::Geometry& geometry, const RobotParts& robot, mjSpec& spec, mjsGeom& geom) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = dynamic_cast<const urdf::Box&>(geometry).dim;
      geom.type = mjGEOM_BOX;
      geom.size[0] = size.x / 2.0;
      geom.size[1] = size.y / 2.0;
      geom.size[2] = size.z / 2.0;
      return;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      geom.type = mjGEOM_CYLINDER;
      geom.size[0] = cylinder.radius;
      geom.size[1] = cylinder.length / 2.0;
      return;
    }
    case urdf::Geometry::SPHERE:
      geom.type = mjGEOM_SPHERE;
      geom.size[0] = dynamic_cast<const urdf::Sphere&>(geometry).radius;
      return;
    case urdf::Geometry::MESH:
      geom.type = mjGEOM_MESH;
      mjs_setString(geom.meshname, add_mesh(dynamic_cast<const urdf::Mesh&>(geometry), robot, spec).c_str());
      return;
  }
}

void set_color(const urdf::Material* material, mjsGeom& geom) {
  if (material == nullptr) return;
  geom.rgba[0] = material->color.r;
  geom.rgba[1] = material->color.g;
  geom.rgba[2] = material->color.b;
  geom.rgba[3] = material->color.a;
}

void add_visuals(const urdf::Link& link, const RobotParts& robot, mjSpec& spec, mjsBody& body) {
  for (const urdf::VisualSharedPtr& visual : link.visual_array) {
    mjsGeom* geom = mjs_addGeom(&body, nullptr);
    set_pose(visual->origin, geom->pos, geom->quat);
    set_shape(*visual->geometry, robot, spec, *geom);
    set_color(visual->material.get(), *geom);
    geom->contype = geom->conaffinity = 0;
    geom->group = kGroupRobotVisual;
    geom->density = 0.0;  // a link without <inertial> has no mass
  }
}

bool is_foot(const urdf::Link& link, const RobotParts& robot) {
  const std::vector<LegGeometry>& legs = robot.description.legs;
  return std::any_of(legs.begin(), legs.end(), [&](const LegGeometry& leg) { return leg.foot_link == link.name; });
}

/// Returns the `motor_ratio` of the first joint of the leg with a joint; 1 for a joint of no leg.
double leg_motor_ratio(const std::string& joint, const RobotParts& robot) {
  const std::vector<std::string>& names = robot.description.joint_names;
  if (robot.description.legs.empty()) return 1.0;
  const auto index = static_cast<std::size_t>(std::find(names.begin(), names.end(), joint) - names.begin());
  return index < names.size() ? motor_ratio(robot.description, index - index % 3) : 1.0;
}

void add_collisions(const urdf::Link& link, const RobotParts& robot, mjSpec& spec, mjsBody& body) {
  for (const urdf::CollisionSharedPtr& collision : link.collision_array) {
    mjsGeom* geom = mjs_addGeom(&body, nullptr);
    set_pose(collision->origin, geom->pos, geom->quat);
    set_shape(*collision->geometry, robot, spec, *geom);
    if (geom->type == mjGEOM_CYLINDER && geom->size[1] >= kSlender * geom->size[0]) geom->type = mjGEOM_CAPSULE;
    geom->contype = kRobotContype;
    geom->conaffinity = kRobotConaffinity;
    geom->group = kGroupRobotCollision;
    geom->condim = 3;
    geom->density = 0.0;  // a link without <inertial> has no mass
    if (is_foot(link, robot)) {
      mjs_setName(geom->element, link.name.c_str());
      geom->priority = 1;
      geom->friction[0] = kFootFriction;
      geom->solref[0] = 0.006;
      geom->solref[1] = 1.0;
      geom->solimp[0] = 0.9;
      geom->solimp[1] = 0.99;
      geom->solimp[2] = 0.001;
    } else {
      mjs_setName(geom->element, (link.name + "_hull").c_str());
    }
  }
}

/// Sets mass and inertia. MuJoCo takes a full tensor in the frame of the body only.
void set_inertia(const urdf::Inertial& inertial, mjsBody& body) {
  body.explicitinertial = true;
  body.mass = inertial.mass;
  double quaternion[4];
  set_pose(inertial.origin, body.ipos, quaternion);
  if (inertial.ixy == 0.0 && inertial.ixz == 0.0 && inertial.iyz == 0.0) {
    std::copy(quaternion, quaternion + 4, body.iquat);
    body.inertia[0] = inertial.ixx;
    body.inertia[1] = inertial.iyy;
    body.inertia[2] = inertial.izz;
    return;
  }
  Eigen::Matrix3d tensor;
  tensor << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz, inertial.ixz,
      inertial.iyz, inertial.izz;
  const Eigen::Matrix3d R =
      Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]).toRotationMatrix();
  tensor = R * tensor * R.transpose();
  const double full[6] = {tensor(0, 0), tensor(1, 1), tensor(2, 2), tensor(0, 1), tensor(0, 2), tensor(1, 2)};
  std::copy_n(full, 6, body.fullinertia);
}

bool is_antenna(const urdf::Joint& joint) { return joint.name.starts_with("tem_"); }

/// Sets a digital servo's 200 : 1 gear behind a small coreless motor. Its friction is viscous, because dry friction is
/// a constraint and slows the physics.
void set_servo_gear(mjsJoint& hinge) {
  hinge.armature = 0.02;
  hinge.damping[0] = 0.3;
}

bool has_tracks(const urdf::ModelInterface& model) { return model.getLink("left_track") != nullptr; }

void add_motor(mjSpec& spec, const urdf::Joint& joint) {
  mjsActuator* motor = mjs_addActuator(&spec, nullptr);
  mjs_setToMotor(motor);
  mjs_setName(motor->element, joint.name.c_str());
  motor->trntype = mjTRN_JOINT;
  mjs_setString(motor->target, joint.name.c_str());
  motor->ctrllimited = mjLIMITED_TRUE;
  motor->ctrlrange[0] = -joint.limits->effort;
  motor->ctrlrange[1] = joint.limits->effort;
}

/// Sets the friction of a gear or bearing, which is also the parking brake and therefore as stiff as the ground.
void set_drive_friction(const urdf::Joint& joint, mjsJoint& hinge) {
  hinge.frictionloss = joint.dynamics ? joint.dynamics->friction : 0.0;
  hinge.solref_friction[0] = 0.01;
  hinge.solimp_friction[0] = hinge.solimp_friction[1] = 0.999;
}

void add_joint(mjSpec& spec, const urdf::Joint& joint, const RobotParts& robot, mjsBody& body) {
  const bool is_endless = joint.type == urdf::Joint::CONTINUOUS;
  if (joint.type != urdf::Joint::REVOLUTE && !is_endless) return;
  mjsJoint* hinge = mjs_addJoint(&body, nullptr);
  mjs_setName(hinge->element, joint.name.c_str());
  hinge->type = mjJNT_HINGE;
  hinge->axis[0] = joint.axis.x;
  hinge->axis[1] = joint.axis.y;
  hinge->axis[2] = joint.axis.z;
  if (is_antenna(joint)) {
    set_servo_gear(*hinge);
  } else if (is_endless && robot.is_tracked) {
    hinge->armature = sprocket_armature();
    set_drive_friction(joint, *hinge);
  } else if (is_endless) {
    set_drive_friction(joint, *hinge);
    hinge->damping[0] = joint.dynamics ? joint.dynamics->damping : 0.0;
  } else {
    const double ratio = leg_motor_ratio(joint.name, robot);
    hinge->armature = ratio * kArmature;
    hinge->damping[0] = ratio * kDamping;
    hinge->frictionloss = ratio * kFrictionLoss;
  }
  if (!is_endless) {
    hinge->limited = mjLIMITED_TRUE;
    const double unit = spec.compiler.degree ? kDegPerRad : 1.0;  // a spec uses the angle unit of its world file
    hinge->range[0] = joint.limits->lower * unit;
    hinge->range[1] = joint.limits->upper * unit;
  }
  if (joint.limits) add_motor(spec, joint);
}

bool turns_endlessly(const urdf::Link& link) {
  return link.parent_joint && link.parent_joint->type == urdf::Joint::CONTINUOUS;
}

void add_link(mjSpec& spec, const urdf::Link& link, const RobotParts& robot, mjsBody& body) {
  mjs_setName(body.element, link.name.c_str());
  if (link.inertial) set_inertia(*link.inertial, body);
  add_visuals(link, robot, spec, body);
  if (is_track(link)) {
    add_wheels(link, robot.road_wheel_load_n, body);
  } else if (!robot.is_tracked && robot.description.legs.empty() && is_wheel(link)) {
    add_rolling_shape(link, body);
  } else if (!robot.is_tracked || !turns_endlessly(link)) {  // the track covers its sprockets
    add_collisions(link, robot, spec, body);
  }
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    mjsBody* child_body = mjs_addBody(&body, nullptr);
    set_pose(child->parent_joint->parent_to_joint_origin_transform, child_body->pos, child_body->quat);
    add_joint(spec, *child->parent_joint, robot, *child_body);
    add_link(spec, *child, robot, *child_body);
    if (child->parent_joint->type == urdf::Joint::FIXED && !is_foot(*child, robot)) {
      mjsSite* site = mjs_addSite(child_body, nullptr);
      mjs_setName(site->element, child->name.c_str());
      site->group = 5;
      site->size[0] = 0.005;
    }
  }
}

std::string text_of(const RobotUrdf& urdf) {
  if (!urdf.text.empty()) return urdf.text;
  std::ifstream file(urdf.path);
  std::ostringstream text;
  text << file.rdbuf();
  return file ? text.str() : "";
}

urdf::ModelInterfaceSharedPtr parse(const RobotUrdf& urdf) {
  const std::string text = text_of(urdf);
  urdf::ModelInterfaceSharedPtr model = text.empty() ? nullptr : urdf::parseURDF(text);
  if (!model) throw InputError(urdf.path + ": not a valid URDF file");
  return model;
}

/// Returns the stance 5 mm above the ground, in whole millimeters.
Stance stance_on_feet(const RobotDescription& robot) {
  constexpr double kGap_m = 0.005;
  Stance stance{.height_m = std::round((robot.body_height_m() + kGap_m) * 1000.0) / 1000.0,
                .support_points_m = {Eigen::Vector2d::Zero()},
                .feet_m = {},
                .max_ground_height_m = 0.3};
  for (const LegGeometry& leg : robot.legs) {
    stance.feet_m.emplace_back(foot_position(leg, leg.standing_rad).head<2>());
  }
  return stance;
}

}  // namespace

Stance to_stance(const RobotUrdf& urdf, const RobotDescription& robot) {
  if (!robot.legs.empty()) return stance_on_feet(robot);
  const urdf::ModelInterfaceSharedPtr model = parse(urdf);
  return has_tracks(*model) ? stance_on_tracks(*model) : stance_on_wheels(*model);
}

void add_robot(mjSpec& world, const RobotUrdf& urdf, const RobotDescription& robot, const Pose3& T_world_body) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf);
  mjsBody* base = mjs_addBody(mjs_findBody(&world, "world"), nullptr);
  std::copy_n(T_world_body.position.data(), 3, base->pos);
  base->quat[0] = T_world_body.rotation.w();
  base->quat[1] = T_world_body.rotation.x();
  base->quat[2] = T_world_body.rotation.y();
  base->quat[3] = T_world_body.rotation.z();
  mjsJoint* freejoint = mjs_addFreeJoint(base);
  mjs_setName(freejoint->element, "robot");
  const RobotParts parts{.description = robot,
                         .folder = std::filesystem::path(urdf.path).parent_path(),
                         .is_tracked = has_tracks(*model),
                         .road_wheel_load_n = road_wheel_load_n(*model)};
  add_link(world, *model->getRoot(), parts, *base);
  if (parts.is_tracked) use_track_options(world.option);
  else if (robot.legs.empty()) use_wheel_friction(world.option);
}

}  // namespace patrol::sim
