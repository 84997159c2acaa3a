#include "studies/landmarks/control_motion.h"

#include <cmath>

namespace patrol::studies {

Pose2 ControlMotion::move(const Pose2& T_map_body, const Control& control) const {
  Eigen::Vector3d pose = T_map_body.vector();
  move_in_place(*this, control.data(), pose.data());
  return {pose.x(), pose.y(), wrap_angle(pose.z())};
}

ControlMotionJacobian jacobian_of(const ControlMotion& motion, const Pose2& T_map_body, const Control& control) {
  const bool is_car = motion.steering == Steering::kAckermann;
  const double dt = motion.step_s / motion.substeps, length_m = control.x() * dt;
  const double yaw_change_rad = is_car ? length_m * std::sin(control.y()) / motion.wheelbase_m : control.y() * dt;
  const double bend_rad = is_car ? control.y() : 0.5 * yaw_change_rad, bend_by_control = is_car ? 1.0 : 0.5 * dt;
  const Eigen::Vector2d yaw_change_by_control =
      is_car ? Eigen::Vector2d(dt * std::sin(control.y()), length_m * std::cos(control.y())) / motion.wheelbase_m
             : Eigen::Vector2d(0.0, dt);
  ControlMotionJacobian jacobian;
  for (int substep = 0; substep < motion.substeps; ++substep) {
    const double direction = T_map_body.yaw + substep * yaw_change_rad + bend_rad, c = std::cos(direction),
                 s = std::sin(direction);
    const Eigen::Vector2d forward(c, s), sideways(-s, c);
    jacobian.pose.topRightCorner<2, 1>() += length_m * sideways;
    // effect of the heading change of earlier substeps
    jacobian.control.topRows<2>() += length_m * sideways * jacobian.control.row(2);
    jacobian.control.topLeftCorner<2, 1>() += dt * forward;
    jacobian.control.topRightCorner<2, 1>() += length_m * bend_by_control * sideways;
    jacobian.control.row(2) += yaw_change_by_control.transpose();
  }
  return jacobian;
}

}  // namespace patrol::studies
