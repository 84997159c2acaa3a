#include "sim/as_built/as_built_model.h"

#include <algorithm>
#include <string>
#include <utility>

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

/// Moves each track by half of the error, so that the center of the robot stays between them.
void move_tracks(double gauge_error_m, mjModel& physics) {
  for (const auto& [side, outward_m] :
       {std::pair("left", 0.5 * gauge_error_m), std::pair("right", -0.5 * gauge_error_m)}) {
    for (const char* part : {"_track", "_sprocket"}) {
      const int body = mj_name2id(&physics, mjOBJ_BODY, (std::string(side) + part).c_str());
      if (body >= 0) physics.body_pos[3 * body + 1] += outward_m;
    }
  }
}

/// Moves each wheel that is not steered by half of the error along y.
void move_wheels(const AsBuiltRobot& robot, mjModel& physics) {
  for (const WheelGeometry& wheel : robot.nominal().wheels) {
    const int body = mj_name2id(&physics, mjOBJ_BODY, wheel.link.c_str());
    if (body < 0 || wheel.steering_joint || wheel.is_caster) continue;
    physics.body_pos[3 * body + 1] += (wheel.is_left() ? 0.5 : -0.5) * robot.wheels().gauge_error_m;
  }
}

}  // namespace

void apply_as_built(const AsBuiltRobot& robot, mjModel& physics) {
  if (!robot.is_as_built()) return;
  move_site(robot, "imu", physics);
  if (robot.nominal().tracks) move_tracks(robot.tracks().gauge_error_m, physics);
  move_wheels(robot, physics);
  for (const LegGeometry& leg : robot.nominal().legs) {
    const int foot = mj_name2id(&physics, mjOBJ_GEOM, leg.foot_link.c_str());
    if (foot >= 0) physics.geom_friction[3 * foot] *= robot.foot_friction_scale();
  }
}

}  // namespace patrol::sim
