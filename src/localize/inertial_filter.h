#pragma once

#include <Eigen/Core>

#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Error-state Kalman filter of the walking trunk: position, attitude, velocity, gyro and accelerometer bias,
/// predicted by the IMU and corrected by what the legs say about the velocity.
///
/// Velocity is kept in body and attitude errors in odom (R = exp(phi) R_estimate), as in robocentric filters
/// (Bloesch et al., "State estimation for legged robots", RSS 2012; "Robust visual inertial odometry", IROS
/// 2015). So yaw and position enter neither the velocity's dynamics nor any measurement: they are dead
/// reckoning, and the filter cannot talk itself into believing otherwise. Roll and pitch need no model of the
/// walk's accelerations: the legs tell the velocity, its change is the acceleration, and what the
/// accelerometer reads beyond that is gravity.
class InertialFilter {
 public:
  struct Settings {
    double gyro_noise_radps_per_sqrt_hz;
    double gyro_bias_std_radps;  ///< at switch-on
    double gyro_bias_walk_radps_per_sqrt_s;
    double accel_noise_mps2_per_sqrt_hz;  ///< with what sampling the shocks of walking adds
    double accel_bias_std_mps2;           ///< at switch-on
    double accel_bias_walk_mps2_per_sqrt_s;
    double way_std_m_per_sqrt_m;       ///< error of the way that is not white in the velocity
    double turn_std_rad_per_sqrt_rad;  ///< the same of the heading, on turns
  };

  /// Starts at odom's origin, heading along x, tilted as gravity in the first sample says.
  InertialFilter(const Settings& settings, const InertialSample& first);

  /// From the last sample to this one.
  void predict(double dt_s, const InertialSample& sample);
  /// Without IMU: keeps velocity and tilt, turns with the rate that the feet tell; uncertainty grows
  /// accordingly.
  void coast(double dt_s, double yaw_rate_radps);

  /// v_measured = v_body + [p_contact]x gyro bias error + white noise; `innovation` = measured - expected at
  /// the instant of the measurement. An innovation beyond the 99.9 % bound is believed less rather than
  /// refused: a filter that refuses can lock itself out.
  void correct_velocity(const Eigen::Vector3d& innovation, const Eigen::Vector3d& p_contact, double variance);
  void correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance);

  const TrunkMotion& motion() const { return motion_; }
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_; }
  const Eigen::Vector3d& accel_bias_mps2() const { return accel_bias_; }
  Eigen::Vector3d up_in_body() const {
    return motion_.T_odom_body.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  }

  /// About odom's z.
  double yaw_rate_radps() const { return (motion_.T_odom_body.rotation * motion_.omega_body).z(); }

  /// Error covariance; rows and columns: position in odom, rotation in odom, velocity in body, gyro bias,
  /// accel bias.
  using Covariance = Eigen::Matrix<double, 15, 15>;
  static constexpr int kPosition = InertialError::kPosition, kRotation = InertialError::kRotation,
                       kVelocity = InertialError::kVelocity, kGyroBias = InertialError::kGyroBias,
                       kAccelBias = InertialError::kAccelBias;
  const Covariance& covariance() const { return P_; }
  /// Of x, y, yaw in odom.
  Eigen::Matrix3d planar_covariance() const;

 private:
  using Gain = Eigen::Matrix<double, 15, 3>;
  void add_dead_reckoning_noise(double dt_s);
  /// P -= W S^-1 W^T and the state with it, where W = P H^T.
  void shift(const Eigen::Matrix<double, 15, 1>& error);
  void apply(const Gain& W, const Eigen::Matrix3d& S_inverse, const Eigen::Vector3d& innovation);

  Settings settings_;
  TrunkMotion motion_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  InertialSample last_;
  Covariance P_ = Covariance::Zero();
};

}  // namespace patrol::localize
