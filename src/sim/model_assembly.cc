#include "sim/model_assembly.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/robot_model.h"

namespace patrol::sim {
namespace {

/// Height of the base above the ground in the start posture: two links of 0.213 m at 0.8 rad, and the foot.
constexpr double kStartHeight_m = 0.322;

bool can_touch(const mjsGeom& geom) { return geom.contype != 0 || geom.conaffinity != 0; }

/// Deletes every geom that no contact can involve; masses are stated in the files, so nothing else changes.
void strip_untouchable(mjSpec& spec) {
  std::vector<mjsElement*> untouchable;
  for (mjsElement* element = mjs_firstElement(&spec, mjOBJ_GEOM); element != nullptr;
       element = mjs_nextElement(&spec, element)) {
    if (!can_touch(*mjs_asGeom(element))) untouchable.push_back(element);
  }
  for (mjsElement* element : untouchable) mjs_delete(&spec, element);
}

/// Height of what one would stand on at (x, y), m: the highest touchable surface below knee height.
double ground_height_m(const std::string& world_xml, const Pose2& T_world_start) {
  SpecPtr spec = load_spec(world_xml);
  strip_untouchable(*spec);
  const ModelPtr model = compile(*spec, world_xml);
  const DataPtr data = make_data(*model);
  mj_forward(model.get(), data.get());
  constexpr double kEyeHeight_m = 0.3;
  const mjtNum from[3] = {T_world_start.x, T_world_start.y, kEyeHeight_m};
  const mjtNum down[3] = {0.0, 0.0, -1.0};
  const mjtNum distance = mj_ray(model.get(), data.get(), from, down, nullptr, 1, -1, nullptr, nullptr);
  if (distance < 0.0) {
    throw InputError(fmt::format("start pose ({:.2f}, {:.2f}): there is no ground below it in {}", T_world_start.x,
                                 T_world_start.y, world_xml));
  }
  return kEyeHeight_m - distance;
}

/// The reference configuration with the legs in the start posture.
std::vector<double> start_configuration(const mjModel& model) {
  std::vector<double> qpos(model.qpos0, model.qpos0 + model.nq);
  for (int joint = 0; joint < model.njnt; ++joint) {
    const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
    if (model.jnt_type[joint] != mjJNT_HINGE || name == nullptr) continue;
    const std::string_view joint_name(name);
    const int kind = joint_name.ends_with("_abduction_joint") ? 0
                     : joint_name.ends_with("_hip_joint")     ? 1
                     : joint_name.ends_with("_knee_joint")    ? 2
                                                              : -1;
    if (kind >= 0) qpos[static_cast<std::size_t>(model.jnt_qposadr[joint])] = kStartPosture[kind];
  }
  return qpos;
}

void refuse_start_inside_something(const mjModel& model, const std::vector<double>& qpos, const Pose2& T_world_start) {
  const DataPtr data = make_data(model);
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  mj_forward(&model, data.get());
  constexpr double kTouchDepth_m = 0.02;
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& contact = data->contact[i];
    if (contact.dist > -kTouchDepth_m) continue;
    const bool first_is_robot = model.geom_group[contact.geom[0]] == kGroupRobotCollision;
    const char* thing = mj_id2name(&model, mjOBJ_GEOM, contact.geom[first_is_robot ? 1 : 0]);
    throw InputError(fmt::format("start pose ({:.2f}, {:.2f}) is inside {}", T_world_start.x, T_world_start.y,
                                 thing == nullptr ? "an obstacle" : thing));
  }
}

/// With sleep enabled, MuJoCo works out the poses of what stands still once and not at every step. The robot never sleeps.
void spare_still_bodies(mjSpec& spec) {
  spec.option.enableflags |= mjENBL_SLEEP;
  mjs_findBody(&spec, frame_id::kBody)->sleep = mjSLEEP_NEVER;
}

SpecPtr make_spec(const std::string& world_xml, const std::string& robot_urdf, const Pose3& T_world_body) {
  SpecPtr spec = load_spec(world_xml);
  add_robot(*spec, robot_urdf, T_world_body);
  return spec;
}

}  // namespace

AssembledModel assemble_model(const std::string& world_xml, const std::string& robot_urdf, const Pose2& T_world_start) {
  const Pose3 T_world_body = to_spatial(T_world_start, ground_height_m(world_xml, T_world_start) + kStartHeight_m);
  AssembledModel assembled;
  assembled.view = compile(*make_spec(world_xml, robot_urdf, T_world_body), world_xml);
  const SpecPtr physics = make_spec(world_xml, robot_urdf, T_world_body);
  strip_untouchable(*physics);
  spare_still_bodies(*physics);
  assembled.physics = compile(*physics, world_xml);
  assembled.start_qpos = start_configuration(*assembled.physics);
  refuse_start_inside_something(*assembled.physics, assembled.start_qpos, T_world_start);
  return assembled;
}

}  // namespace patrol::sim
