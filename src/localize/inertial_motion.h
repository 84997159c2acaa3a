#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/frames.h"
#include "core/gravity.h"

/// Strapdown inertial navigation over short steps and its error propagation, common to the filters of both robots.
namespace patrol::localize {

/// Angular rate and specific force at the trunk origin, in body, as measured (including bias).
struct InertialSample {
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_mps2 = Eigen::Vector3d::Zero();
};

/// Motion state of the trunk. The velocity is that of the trunk origin, in body.
struct TrunkMotion {
  Pose3 T_odom_body;
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();      ///< m/s
  Eigen::Vector3d omega_body = Eigen::Vector3d::Zero();  ///< rad/s, bias removed
};

/// Returns [v]x: cross_matrix(v) * w = v x w.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// Returns the rotation by a vector, to third order: for steps of a few milliradians.
Eigen::Quaterniond rotation_by(const Eigen::Vector3d& angle_rad);

/// Returns roll and pitch for which gravity reads `force` at rest; yaw 0.
Eigen::Quaterniond tilt_from_gravity(const Eigen::Vector3d& force);

/// Returns the rotation error in odom per accelerometer bias in body, for a tilt that was taken from gravity at rest:
/// the biased specific force looks level.
Eigen::Matrix3d tilt_error_by_accel_bias(const Eigen::Quaterniond& R_odom_body);

/// Dead-reckoning step with its linearization point.
struct InertialStep {
  TrunkMotion after;                                          ///< its omega is the mean rate of the step
  Eigen::Matrix3d R_odom_body = Eigen::Matrix3d::Identity();  ///< rotation at the middle of the step
  Eigen::Vector3d v_body = Eigen::Vector3d::Zero();           ///< velocity at the middle of the step, m/s
};

/// Integrates one step. `omega_radps` and `force_mps2` are means over the step, in body, without bias.
InertialStep integrate(const TrunkMotion& before, double dt_s, const Eigen::Vector3d& omega_radps,
                       const Eigen::Vector3d& force_mps2);

/// Layout of the rows and columns of an error covariance: position in odom, rotation in odom, velocity in body, gyro
/// bias, accelerometer bias. The additional states of a filter follow.
struct InertialError {
  static constexpr int kPosition = 0, kRotation = 3, kVelocity = 6, kGyroBias = 9, kAccelBias = 12, kSize = 15;
};

/// Adds to the covariance that a tilt taken from gravity has the error of the accelerometer bias, which must be set.
template <typename Covariance>
void correlate_start_tilt(Covariance& P, const Eigen::Quaterniond& R_odom_body) {
  using Error = InertialError;
  const Eigen::Matrix3d by_bias = tilt_error_by_accel_bias(R_odom_body);
  const Eigen::Matrix3d bias = P.template block<3, 3>(Error::kAccelBias, Error::kAccelBias);
  P.template block<3, 3>(Error::kRotation, Error::kRotation) += by_bias * bias * by_bias.transpose();
  P.template block<3, 3>(Error::kRotation, Error::kAccelBias) = by_bias * bias;
  P.template block<3, 3>(Error::kAccelBias, Error::kRotation) = bias * by_bias.transpose();
}

/// Propagates the error covariance. With R_true = exp(phi) R, omega_true = omega - dbg, force_true = force - dba, to
/// first order:
///   dp'   = R dv - [R v]x phi
///   phi'  = -R dbg
///   dv'   = R^T [g]x phi - [omega]x dv - [v]x dbg - dba
/// P = F P F^T with F = I + dt A. F is applied to the rows in place, before and after a transposition of the symmetric
/// P. Each row block uses only blocks that are not yet overwritten. Errors beyond the first fifteen are constant.
template <typename Covariance>
void propagate_inertial_errors(Covariance& P, double dt_s, const Eigen::Matrix3d& R, const Eigen::Vector3d& v,
                               const Eigen::Vector3d& omega) {
  using Error = InertialError;
  const Eigen::Matrix3d R_dt = dt_s * R;
  const Eigen::Matrix3d p_from_rotation = -dt_s * cross_matrix(R * v);
  const Eigen::Matrix3d v_from_rotation = R_dt.transpose() * cross_matrix(Eigen::Vector3d(0.0, 0.0, -kGravity_mps2));
  const Eigen::Matrix3d v_from_v = -dt_s * cross_matrix(omega);
  const Eigen::Matrix3d v_from_gyro_bias = -dt_s * cross_matrix(v);
  for (int pass = 0; pass < 2; ++pass) {
    for (int col = 0; col < P.cols(); ++col) {
      auto column = P.col(col);
      const Eigen::Vector3d rotation = column.template segment<3>(Error::kRotation);
      const Eigen::Vector3d velocity = column.template segment<3>(Error::kVelocity);
      const Eigen::Vector3d gyro_bias = column.template segment<3>(Error::kGyroBias);
      const Eigen::Vector3d accel_bias = column.template segment<3>(Error::kAccelBias);
      column.template segment<3>(Error::kPosition) += p_from_rotation * rotation + R_dt * velocity;
      column.template segment<3>(Error::kRotation) -= R_dt * gyro_bias;
      column.template segment<3>(Error::kVelocity) +=
          v_from_rotation * rotation + v_from_v * velocity + v_from_gyro_bias * gyro_bias - dt_s * accel_bias;
    }
    P.transposeInPlace();
  }
}

}  // namespace patrol::localize
