#include "slam/landmarks/control_motion.h"

#include <cmath>

namespace patrol::slam {
namespace {

/// The step is `length_m` in the direction yaw + `bend_rad`, and a turn by `turn_rad`.
struct Step {
  double length_m = 0.0, bend_rad = 0.0, turn_rad = 0.0;
};

Step step_of(const ControlMotion& motion, const Control& control) {
  const double length_m = control.x() * motion.step_s;
  if (motion.steering == Steering::kAckermann) {
    return {.length_m = length_m, .bend_rad = control.y(), .turn_rad = length_m * std::sin(control.y()) / motion.wheelbase_m};
  }
  const double turn_rad = control.y() * motion.step_s;
  return {.length_m = length_m, .bend_rad = 0.5 * turn_rad, .turn_rad = turn_rad};
}

}  // namespace

Pose2 ControlMotion::move(const Pose2& T_map_body, const Control& control) const {
  const Step step = step_of(*this, control);
  const double direction = T_map_body.yaw + step.bend_rad;
  return {T_map_body.x + step.length_m * std::cos(direction), T_map_body.y + step.length_m * std::sin(direction),
          wrap_angle(T_map_body.yaw + step.turn_rad)};
}

ControlMotionJacobian jacobian_of(const ControlMotion& motion, const Pose2& T_map_body, const Control& control) {
  const Step step = step_of(motion, control);
  const double direction = T_map_body.yaw + step.bend_rad, c = std::cos(direction), s = std::sin(direction);
  const double dt = motion.step_s;
  ControlMotionJacobian jacobian;
  jacobian.pose(0, 2) = -step.length_m * s;
  jacobian.pose(1, 2) = step.length_m * c;
  const bool is_car = motion.steering == Steering::kAckermann;
  const double bend_by_turn = is_car ? 1.0 : 0.5 * dt;
  jacobian.control << dt * c, -step.length_m * s * bend_by_turn,  //
      dt * s, step.length_m * c * bend_by_turn,                   //
      is_car ? dt * std::sin(control.y()) / motion.wheelbase_m : 0.0, is_car ? step.length_m * std::cos(control.y()) / motion.wheelbase_m : dt;
  return jacobian;
}

}  // namespace patrol::slam
