#include "localize/inertial_motion.h"

#include <cmath>

namespace patrol::localize {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& angle_rad) {
  const double squared = angle_rad.squaredNorm();
  const Eigen::Vector3d half = (0.5 - squared / 48.0) * angle_rad;
  return Eigen::Quaterniond(1.0 - squared / 8.0, half.x(), half.y(), half.z()).normalized();
}

Eigen::Quaterniond tilt_from_gravity(const Eigen::Vector3d& force) {
  return quaternion_from_rpy(std::atan2(force.y(), force.z()), std::atan2(-force.x(), std::hypot(force.y(), force.z())),
                             0.0);
}

Eigen::Matrix3d tilt_error_by_accel_bias(const Eigen::Quaterniond& R_odom_body) {
  return cross_matrix(Eigen::Vector3d::UnitZ()) * R_odom_body.toRotationMatrix() / kGravity_mps2;
}

InertialStep integrate(const TrunkMotion& before, double dt_s, const Eigen::Vector3d& omega,
                       const Eigen::Vector3d& force) {
  const Eigen::Quaterniond& rotation = before.T_odom_body.rotation;
  const Eigen::Vector3d& v_start = before.v_body;
  const Eigen::Quaterniond rotation_mid = rotation * rotation_by(0.5 * dt_s * omega);
  InertialStep step;
  step.R_odom_body = rotation_mid.toRotationMatrix();
  const Eigen::Vector3d gravity = step.R_odom_body.transpose() * Eigen::Vector3d(0.0, 0.0, -kGravity_mps2);
  step.v_body = v_start + 0.5 * dt_s * (force + gravity - omega.cross(v_start));
  step.after.v_body = v_start + dt_s * (force + gravity - omega.cross(step.v_body));
  step.after.T_odom_body.position = before.T_odom_body.position + dt_s * (step.R_odom_body * step.v_body);
  step.after.T_odom_body.rotation = (rotation_mid * rotation_by(0.5 * dt_s * omega)).normalized();
  step.after.omega_body = omega;
  return step;
}

}  // namespace patrol::localize
