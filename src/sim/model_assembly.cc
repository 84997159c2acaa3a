#include "sim/model_assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/antenna_mount.h"

// Digits of the numbers that MuJoCo writes to MJCF. Its library exports these functions, its headers do not declare
// them.
extern "C" {
int _mjPRIVATE__get_xml_precision();                // NOLINT(bugprone-reserved-identifier)
void _mjPRIVATE__set_xml_precision(int precision);  // NOLINT(bugprone-reserved-identifier)
}

namespace patrol::sim {
namespace {

constexpr mjtByte kScenery[mjNGROUP] = {1, 1, 1, 1, 0, 0};  // all groups but the robot's own

/// Removes every geom that cannot be in contact, and the images. Masses are explicit in the files, so nothing else
/// changes.
void strip_visuals(mjSpec& spec) {
  spec.compiler.discardvisual = true;
  drop_textures(spec);
}

SpecPtr load_world(const std::string& world_xml, const std::vector<StaticObstacleSettings>& obstacles) {
  SpecPtr spec = load_spec(world_xml);
  add_static_obstacles(*spec, obstacles);
  return spec;
}

/// Height of the highest ground plane at a point; none without a plane.
std::optional<double> plane_height_m(const mjModel& model, const mjData& data, const Eigen::Vector2d& p_world) {
  std::optional<double> height_m;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_type[geom] != mjGEOM_PLANE || kScenery[model.geom_group[geom]] == 0) continue;
    const mjtNum *center = data.geom_xpos + 3 * geom, *R = data.geom_xmat + 9 * geom;
    const Eigen::Vector3d normal(R[2], R[5], R[8]);
    if (normal.z() < std::sqrt(0.5)) continue;
    const Eigen::Vector2d moved = p_world - Eigen::Vector2d(center[0], center[1]);
    const double z_m = center[2] - normal.head<2>().dot(moved) / normal.z();
    height_m = std::max(height_m.value_or(z_m), z_m);
  }
  return height_m;
}

/// Returns the height of the lowest floor at a point: a plane or a surface that faces up, with free space of at least
/// `kMinFree_m` above it. Objects that stand on a plane and are higher than `kMaxPlatform_m` have no floor.
std::optional<double> lowest_floor_m(const mjModel& model, const mjData& data, const Eigen::Vector2d& p_world) {
  constexpr double kMinFree_m = 0.5, kMaxPlatform_m = 1.0, kBelowSurface_m = 1e-3;
  constexpr int kMaxSurfaces = 1000;
  const mjtNum down[3] = {0.0, 0.0, -1.0};
  const std::optional<double> plane_m = plane_height_m(model, data, p_world);
  double from_m = plane_m.value_or(0.0);
  for (int geom = 0; geom < model.ngeom; ++geom)
    from_m = std::max(from_m, data.geom_xpos[3 * geom + 2] + model.geom_rbound[geom] + 1.0);
  std::optional<double> floor_m;
  double above_m = std::numeric_limits<double>::infinity();
  bool is_free = true;  // no solid directly above the next surface
  for (int i = 0; i < kMaxSurfaces; ++i) {
    const mjtNum from[3] = {p_world.x(), p_world.y(), from_m};
    mjtNum normal[3];
    const mjtNum distance = mj_ray(&model, &data, from, down, kScenery, true, -1, nullptr, normal);
    const double height_m = from_m - distance;
    if (distance < 0.0 || (plane_m && height_m <= *plane_m)) break;
    if (normal[2] > 0.0 && is_free && above_m - height_m >= kMinFree_m) floor_m = height_m;
    is_free = normal[2] < 0.0;
    above_m = height_m;
    from_m = height_m - kBelowSurface_m;
  }
  if (plane_m && (above_m - *plane_m >= kMinFree_m || floor_m.value_or(0.0) - *plane_m > kMaxPlatform_m))
    floor_m = plane_m;
  return floor_m;
}

/// Returns the height of the floor of a start. The top of an object that is surrounded by a floor lower than 45 degrees
/// is none.
std::optional<double> start_floor_m(const mjModel& model, const mjData& data, const Eigen::Vector2d& p_world) {
  constexpr int kDirections = 8;
  const std::optional<double> center_m = lowest_floor_m(model, data, p_world);
  std::optional<double> floor_m = center_m;
  for (const double radius_m : {1.0, 2.0}) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kDirections;
      const std::optional<double> near_m =
          lowest_floor_m(model, data, p_world + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      if (near_m && (!center_m || *near_m < *center_m - radius_m))
        floor_m = std::min(*near_m, floor_m.value_or(*near_m));
    }
  }
  return floor_m;
}

/// Returns the height below which the ground of a start is searched. It is the same for all floors near 0.
double max_start_ground_m(const mjModel& model, const mjData& data, const Stance& stance, const Pose2& T_world_start) {
  constexpr double kNearZero_m = 0.2;
  const double floor_m = start_floor_m(model, data, T_world_start.position()).value_or(0.0);
  return stance.max_ground_height_m + (std::abs(floor_m) <= kNearZero_m ? 0.0 : floor_m);
}

double height_in(mjSpec& world, const std::string& world_xml, const Stance& stance, const Pose2& T_world_start) {
  strip_visuals(world);
  const ModelPtr model = compile(world, world_xml);
  const DataPtr data = make_data(*model);
  mj_forward(model.get(), data.get());
  try {
    const double max_m = max_start_ground_m(*model, *data, stance, T_world_start);
    return ground_height_m(*model, *data, stance, T_world_start, max_m) + stance.height_m;
  } catch (const InputError& error) {
    throw InputError(fmt::format("start pose {} in {}", error.what(), world_xml));
  }
}

void refuse_start_in_collision(const mjModel& model, const std::vector<double>& qpos, const Pose2& T_world_start) {
  const DataPtr data = make_data(model);
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  mj_forward(&model, data.get());
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& contact = data->contact[i];
    if (contact.dist > -kMaxStartDepth_m) continue;
    const bool first_is_robot = model.geom_group[contact.geom[0]] == kGroupRobotCollision;
    const std::string_view object = name_of(model, mjOBJ_GEOM, contact.geom[first_is_robot ? 1 : 0]);
    throw InputError(fmt::format("start pose ({:.2f}, {:.2f}): in collision with {}", T_world_start.x, T_world_start.y,
                                 object.empty() ? "an obstacle" : object));
  }
}

/// Enables sleep, with which MuJoCo computes the poses of static bodies once instead of at every step. The robot never
/// sleeps.
void enable_sleep(mjSpec& spec) {
  spec.option.enableflags |= mjENBL_SLEEP;
  mjs_findBody(&spec, frame_id::kBody)->sleep = mjSLEEP_NEVER;
}

/// Sets the inertial frames that bodies leave undefined, as MuJoCo's compiler does: to the pose of the body in its
/// parent. MuJoCo writes no inertia without one.
void complete_inertial_frames(mjSpec& spec) {
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_BODY); element != nullptr;
       element = mjs_nextElement(&spec, element)) {
    mjsBody* body = mjs_asBody(element);
    if (!body->explicitinertial || std::isfinite(body->ipos[0])) continue;
    std::copy_n(body->pos, 3, body->ipos);
    std::copy_n(body->quat, 4, body->iquat);
  }
}

/// Writes a compiled model with numbers that are read back without loss. With MuJoCo's default of six digits, masses
/// would not add up to 1e-6, and rounded moments of inertia could violate A + B >= C.
std::string exact_xml_of(const mjSpec& spec, const std::string& path) {
  const int digits = _mjPRIVATE__get_xml_precision();
  _mjPRIVATE__set_xml_precision(std::numeric_limits<double>::max_digits10);
  std::string xml(std::size_t{1} << 24, '\0'), error(1000, '\0');
  const int failure =
      mj_saveXMLString(&spec, xml.data(), static_cast<int>(xml.size()), error.data(), static_cast<int>(error.size()));
  _mjPRIVATE__set_xml_precision(digits);
  if (failure != 0) throw InputError(fmt::format("{}: cannot be written as MJCF: {}", path, error.c_str()));
  xml.resize(xml.find('\0'));
  return xml;
}

}  // namespace

double ground_height_m(const mjModel& model, const mjData& data, const Stance& stance, const Pose2& T_world_body,
                       double max_ground_height_m) {
  const mjtNum down[3] = {0.0, 0.0, -1.0};
  double nearest_m = std::numeric_limits<double>::infinity();
  const auto cast_ray = [&](const Eigen::Vector2d& p_level, double tolerance_m) {
    const Eigen::Vector2d p_world = T_world_body * p_level;
    const mjtNum from[3] = {p_world.x(), p_world.y(), max_ground_height_m};
    const mjtNum distance = mj_ray(&model, &data, from, down, kScenery, true, -1, nullptr, nullptr);
    if (distance >= 0.0) nearest_m = std::min(nearest_m, distance + tolerance_m);
  };
  for (const Eigen::Vector2d& support : stance.support_points_m) cast_ray(support, 0.0);
  for (const Eigen::Vector2d& foot : stance.feet_m) cast_ray(foot, kMaxStartDepth_m);
  if (!std::isfinite(nearest_m)) {
    throw InputError(fmt::format("({:.2f}, {:.2f}): no ground below", T_world_body.x, T_world_body.y));
  }
  return max_ground_height_m - nearest_m;
}

void set_standing_posture(const mjModel& model, const RobotDescription& robot, mjtNum* qpos) {
  for (std::size_t i = 0; i < 3 * robot.legs.size(); ++i) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, robot.joint_names[i].c_str());
    if (joint < 0) throw InputError("robot model: joint not found: " + robot.joint_names[i]);
    qpos[model.jnt_qposadr[joint]] = robot.legs[i / 3].standing_rad[static_cast<Eigen::Index>(i % 3)];
  }
}

std::string mjcf_of(const RobotUrdf& robot_urdf, const RobotDescription& robot) {
  constexpr double kStraightLegs_m = 0.2;
  const SpecPtr spec = parse_spec(R"(<mujoco><option timestep="0.002"/><worldbody><light pos="0 0 3"/>
      <geom name="ground" type="plane" size="10 10 0.1" conaffinity="2"/></worldbody></mujoco>)");
  const double height_m = to_stance(robot_urdf, robot).height_m;
  add_robot(*spec, robot_urdf, robot, to_pose3(Pose2{}, height_m));
  complete_inertial_frames(*spec);
  const ModelPtr model = compile(*spec, robot_urdf.path);
  std::vector<double> qpos(model->qpos0, model->qpos0 + model->nq);
  set_standing_posture(*model, robot, qpos.data());
  if (!robot.legs.empty())  // legs that are straight at zero reach below the ground
    mjs_findBody(spec.get(), frame_id::kBody)->pos[2] += kStraightLegs_m;
  stow_antenna(*model, qpos.data());
  mjsKey* key = mjs_addKey(spec.get());
  mjs_setName(key->element, "standing");
  mjs_setDouble(key->qpos, qpos.data(), static_cast<int>(model->nq));
  compile(*spec, robot_urdf.path);
  return exact_xml_of(*spec, robot_urdf.path);
}

AssembledModel assemble_model(const std::string& world_xml, const RobotUrdf& robot_urdf, const RobotDescription& robot,
                              const Pose2& T_world_start, const std::vector<StaticObstacleSettings>& obstacles,
                              Textures textures) {
  AssembledModel assembled;
  assembled.stance = to_stance(robot_urdf, robot);
  const double height_m = height_in(*load_world(world_xml, obstacles), world_xml, assembled.stance, T_world_start);
  const SpecPtr view = load_world(world_xml, obstacles), physics = load_world(world_xml, obstacles);
  for (mjSpec* spec : {view.get(), physics.get()})
    add_robot(*spec, robot_urdf, robot, to_pose3(T_world_start, height_m));
  if (textures == Textures::kNone) drop_textures(*view);
  strip_visuals(*physics);
  enable_sleep(*physics);
  assembled.view = compile(*view, world_xml);
  assembled.physics = compile(*physics, world_xml);
  const mjModel& model = *assembled.physics;
  assembled.start_qpos.assign(model.qpos0, model.qpos0 + model.nq);
  set_standing_posture(model, robot, assembled.start_qpos.data());
  stow_antenna(model, assembled.start_qpos.data());
  refuse_start_in_collision(model, assembled.start_qpos, T_world_start);
  return assembled;
}

Time tick_of(const std::string& world_xml) { return from_seconds(load_spec(world_xml)->option.timestep); }

double start_height_m(const std::string& world_xml, const RobotUrdf& robot_urdf, const RobotDescription& robot,
                      const Pose2& T_world_start) {
  return height_in(*load_spec(world_xml), world_xml, to_stance(robot_urdf, robot), T_world_start);
}

}  // namespace patrol::sim
