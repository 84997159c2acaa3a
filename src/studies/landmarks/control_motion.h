#pragma once

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::studies {

/// Kinematics of the vehicle: meaning of the second control.
enum class Steering {
  kYawRate,    ///< quadruped or tracked vehicle: speed and yaw rate, rad/s
  kAckermann,  ///< car: speed of the front wheel and steering angle, rad
};

/// Measured motion in one step: (speed in m/s, yaw rate in rad/s or steering angle in rad).
using Control = Eigen::Vector2d;

struct ControlMotion {
  Steering steering = Steering::kYawRate;
  double wheelbase_m = 2.0;  ///< wheelbase of a car
  double step_s = 0.1;
  int substeps = 1;  ///< number of substeps of the integration; a turning car follows an arc
  /// Standard deviation of each control's error in a step, in its unit.
  Eigen::Vector2d std = Eigen::Vector2d(0.1, 0.087);

  Pose2 move(const Pose2& T_map_body, const Control& control) const;
  /// Applies the control plus an error. `increment` is the error of the control in standard deviations.
  Pose2 move_with_noise(const Pose2& T_map_body, const Control& control, const Eigen::Vector2d& increment) const {
    return move(T_map_body, control + std.cwiseProduct(increment));
  }
};

/// Integrates one step of `pose` (x, y, yaw) in place, for any scalar type; the yaw is not wrapped.
template <typename Scalar>
void move_in_place(const ControlMotion& motion, const Scalar* control, Scalar* pose) {
  using std::cos, std::sin;
  const Scalar length_m = control[0] * (motion.step_s / motion.substeps);
  const bool is_car = motion.steering == Steering::kAckermann;
  const Scalar yaw_change_rad = is_car ? Scalar(length_m * sin(control[1]) / motion.wheelbase_m)
                                       : Scalar(control[1] * (motion.step_s / motion.substeps));
  const Scalar bend_rad = is_car ? control[1] : Scalar(0.5 * yaw_change_rad);
  for (int substep = 0; substep < motion.substeps; ++substep) {
    const Scalar direction = pose[2] + bend_rad;
    pose[0] += length_m * cos(direction);
    pose[1] += length_m * sin(direction);
    pose[2] += yaw_change_rad;
  }
}

/// Derivatives of (x, y, yaw) after a step.
struct ControlMotionJacobian {
  Eigen::Matrix3d pose = Eigen::Matrix3d::Identity();  ///< derivative with respect to (x, y, yaw) before the step
  /// Derivative with respect to the control.
  Eigen::Matrix<double, 3, 2> control = Eigen::Matrix<double, 3, 2>::Zero();
};

ControlMotionJacobian jacobian_of(const ControlMotion& motion, const Pose2& T_map_body, const Control& control);

}  // namespace patrol::studies
