#include "sim/as_built/as_built_model.h"

#include <algorithm>
#include <string>

namespace patrol::sim {
namespace {

void move_site(const AsBuiltRobot& robot, const std::string& frame, mjModel& physics) {
  const int site = mj_name2id(&physics, mjOBJ_SITE, frame.c_str());
  if (site < 0 || !robot.actual().T_body_sensor.contains(frame)) return;
  const Pose3 T_nominal_actual = robot.nominal().T_body(frame).inverse() * robot.actual().T_body(frame);
  mjtNum* const p = physics.site_pos + 3 * site;
  mjtNum* const q = physics.site_quat + 4 * site;
  const Pose3 moved = Pose3{Eigen::Vector3d(p), Eigen::Quaterniond(q[0], q[1], q[2], q[3])} * T_nominal_actual;
  const double rotation[4] = {moved.rotation.w(), moved.rotation.x(), moved.rotation.y(), moved.rotation.z()};
  std::copy_n(moved.position.data(), 3, p);
  std::copy_n(rotation, 4, q);
  physics.site_sameframe[site] = mjSAMEFRAME_NONE;
}

}  // namespace

void apply_as_built(const AsBuiltRobot& robot, mjModel& physics) {
  if (!robot.is_as_built()) return;
  move_site(robot, "imu", physics);
  for (const LegGeometry& leg : robot.nominal().legs) {
    const int foot = mj_name2id(&physics, mjOBJ_GEOM, (leg.name + "_foot").c_str());
    if (foot >= 0) physics.geom_friction[3 * foot] *= robot.foot_friction_scale();
  }
}

}  // namespace patrol::sim
