#include "sim/track_model.h"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <limits>

#include <Eigen/Core>

#include "core/error.h"
#include "core/gravity.h"

namespace patrol::sim {
namespace {

// Springs: natural frequency of 4.6 Hz for the whole robot, damping ratio of one third.
constexpr double kSpringStiffness = 6000.0, kSpringDamping = 150.0;  // N/m, N s/m
constexpr double kDroop_m = 0.02, kBump_m = 0.03;                    // travel from the loaded position
constexpr double kWheelMass_kg = 0.8, kWheelInertia_kgm2 = 0.002;

// Sum of the rotor inertia (flat brushless motors of 100 to 300 W: 1.2e-4 to 3.1e-4 kg m2) through a gear of 30, 6 kg
// of belt at its pitch line, and the driven wheels. Below 0.2 the contact torque, one tick late, makes track and motor
// oscillate.
constexpr double kSprocketArmature_kgm2 = 0.25;

void set(double* to, std::initializer_list<double> values) { std::copy(values.begin(), values.end(), to); }

const urdf::Cylinder& wheel_shape(const urdf::Collision& wheel) {
  if (wheel.geometry->type != urdf::Geometry::CYLINDER)
    throw InputError(wheel.name + ": wheels of a track must be cylinders");
  return dynamic_cast<const urdf::Cylinder&>(*wheel.geometry);
}

/// Returns the height of the lowest point of a track's wheels, in the link, m.
double bottom_m(const urdf::Link& track) {
  double bottom = std::numeric_limits<double>::infinity();
  for (const urdf::CollisionSharedPtr& wheel : track.collision_array) {
    bottom = std::min(bottom, wheel->origin.position.z - wheel_shape(*wheel).radius);
  }
  return bottom;
}

bool is_road_wheel(const urdf::Link& track, const urdf::Collision& wheel) {
  return wheel.origin.position.z - wheel_shape(wheel).radius < bottom_m(track) + 1e-3;
}

/// Adds the body of a road wheel, with its spring loaded by `load_n` at its position in the URDF.
mjsBody* add_suspension(const urdf::Collision& wheel, double load_n, mjsBody& track) {
  mjsBody* carrier = mjs_addBody(&track, nullptr);
  mjs_setName(carrier->element, (wheel.name + "_carrier").c_str());
  const urdf::Vector3& center = wheel.origin.position;
  set(carrier->pos, {center.x, center.y, center.z});
  carrier->explicitinertial = true;
  carrier->mass = kWheelMass_kg;
  set(carrier->ipos, {0.0, 0.0, 0.0});
  set(carrier->iquat, {1.0, 0.0, 0.0, 0.0});
  std::fill_n(carrier->inertia, 3, kWheelInertia_kgm2);
  mjsJoint* slide = mjs_addJoint(carrier, nullptr);
  mjs_setName(slide->element, (wheel.name + "_spring").c_str());
  slide->type = mjJNT_SLIDE;
  set(slide->axis, {0.0, 0.0, 1.0});
  slide->stiffness[0] = kSpringStiffness;
  slide->damping[0] = kSpringDamping;
  slide->springref = -load_n / kSpringStiffness;
  slide->limited = mjLIMITED_TRUE;
  slide->range[0] = -kDroop_m;
  slide->range[1] = kBump_m;
  return carrier;
}

/// Adds a wheel with rounded edges of the width in the URDF: a transverse capsule, or a sphere if the wheel is at most
/// 5 % wider than high.
void add_wheel(const urdf::Collision& wheel, mjsBody& body, bool is_at_origin) {
  const urdf::Cylinder& shape = wheel_shape(wheel);
  mjsGeom* geom = mjs_addGeom(&body, nullptr);
  mjs_setName(geom->element, wheel.name.c_str());
  const urdf::Vector3& center = wheel.origin.position;
  if (!is_at_origin) set(geom->pos, {center.x, center.y, center.z});
  const urdf::Rotation& q = wheel.origin.rotation;
  set(geom->quat, {q.w, q.x, q.y, q.z});
  constexpr double kAlmostRound = 0.05;
  const double straight_m = shape.length / 2.0 - shape.radius;
  geom->type = straight_m > kAlmostRound * shape.radius ? mjGEOM_CAPSULE : mjGEOM_SPHERE;
  geom->size[0] = shape.radius;
  geom->size[1] = straight_m;
  geom->contype = kRobotContype;
  geom->conaffinity = kRobotConaffinity;
  geom->group = kGroupRobotCollision;
  geom->condim = 3;
  geom->priority = 1;
  set(geom->solimp, {0.995, 0.999, 0.001});  // creeps by half a millimeter per second on 10 degrees
}

}  // namespace

bool is_track(const urdf::Link& link) { return link.name.ends_with("_track"); }

double road_wheel_load_n(const urdf::ModelInterface& robot) {
  double mass_kg = 0.0;
  std::ptrdiff_t wheels = 0;
  for (const auto& [name, link] : robot.links_) {
    if (link->inertial) mass_kg += link->inertial->mass;
    if (!is_track(*link)) continue;
    wheels += std::count_if(link->collision_array.begin(), link->collision_array.end(),
                            [&robot_link = *link](const auto& wheel) { return is_road_wheel(robot_link, *wheel); });
  }
  return wheels == 0 ? 0.0 : (mass_kg / static_cast<double>(wheels) - kWheelMass_kg) * kGravity_mps2;
}

void add_wheels(const urdf::Link& track, double load_n, mjsBody& body) {
  Eigen::Map<Eigen::Vector3d> center_m(body.ipos);
  for (const urdf::CollisionSharedPtr& wheel : track.collision_array) {
    const bool is_sprung = is_road_wheel(track, *wheel);
    add_wheel(*wheel, is_sprung ? *add_suspension(*wheel, load_n, body) : body, is_sprung);
    if (!is_sprung) continue;
    const urdf::Vector3& p_wheel = wheel->origin.position;
    const Eigen::Vector3d moment =
        body.mass * center_m - kWheelMass_kg * Eigen::Vector3d(p_wheel.x, p_wheel.y, p_wheel.z);
    body.mass -= kWheelMass_kg;
    center_m = moment / body.mass;
  }
}

double sprocket_armature() { return kSprocketArmature_kgm2; }

void use_track_options(mjOption& option) {
  option.jacobian = mjJAC_SPARSE;  // wheels couple only through the body: a tenth faster
  option.cone = mjCONE_PYRAMIDAL;
  option.impratio = 1.0;
}

Stance stance_on_tracks(const urdf::ModelInterface& robot) {
  constexpr double kDrop_m = 0.01;
  Stance stance{
      .height_m = 0.0, .support_points_m = {Eigen::Vector2d::Zero()}, .feet_m = {}, .max_ground_height_m = 1.0};
  for (const char* name : {"left_track", "right_track"}) {
    const urdf::LinkConstSharedPtr track = robot.getLink(name);
    if (!track) throw InputError("robot " + robot.getName() + ": link not found: " + name);
    const urdf::Vector3& origin = track->parent_joint->parent_to_joint_origin_transform.position;
    for (const urdf::CollisionSharedPtr& wheel : track->collision_array) {
      const urdf::Vector3& center = wheel->origin.position;
      const double radius_m = wheel_shape(*wheel).radius;
      stance.height_m = std::max(stance.height_m, radius_m - center.z - origin.z + kDrop_m);
      stance.support_points_m.emplace_back(origin.x + center.x, origin.y + center.y);
    }
  }
  return stance;
}

}  // namespace patrol::sim
