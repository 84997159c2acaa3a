#pragma once

#include <Eigen/Core>

#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Error-state Kalman filter of the trunk of a legged robot: position, attitude, velocity, gyro and accelerometer bias.
/// Predicted with the IMU and corrected with the trunk velocity from leg kinematics.
///
/// The velocity is expressed in body and attitude errors in odom (R = exp(phi) R_estimate), as in robocentric filters
/// [Bloesch12], [Bloesch15]. Yaw and position then affect neither the velocity dynamics nor any measurement. They are
/// dead reckoning, and the filter cannot become overconfident about them. Roll and pitch need no model of the
/// accelerations of walking: the legs measure the velocity, whose derivative is the acceleration. The rest of the
/// accelerometer reading is gravity.
class InertialFilter {
 public:
  struct Settings {
    double gyro_noise_density_radps_per_sqrt_hz;
    double gyro_bias_std_radps;  ///< standard deviation at power-on
    double gyro_bias_random_walk_radps_per_sqrt_s;
    double accel_noise_density_mps2_per_sqrt_hz;  ///< includes the aliasing of walking shocks
    double accel_bias_std_mps2;                   ///< standard deviation at power-on
    double accel_bias_random_walk_mps2_per_sqrt_s;
    double
        position_random_walk_m_per_sqrt_m;    ///< position random walk: errors that are not white noise of the velocity
    double yaw_random_walk_rad_per_sqrt_rad;  ///< yaw random walk during rotation
  };

  /// Starts at the origin of odom with heading along x; tilt from gravity in the first sample.
  InertialFilter(const Settings& settings, const InertialSample& first);

  /// Predicts from the previous sample to this one.
  void predict(double dt_s, const InertialSample& sample);
  /// Predicts without IMU: velocity and tilt are constant, the yaw rate is that of the feet. The covariance increases
  /// accordingly.
  void coast(double dt_s, double yaw_rate_radps);

  /// Corrects with a velocity: v_measured = v_body + [p_contact]x gyro bias error + white noise. `innovation` =
  /// measured - expected at the time of the measurement. An innovation beyond the 99.9 % bound is down-weighted instead
  /// of rejected, because a filter that rejects measurements can diverge permanently.
  void correct_velocity(const Eigen::Vector3d& innovation, const Eigen::Vector3d& p_contact, double variance);
  void correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance);

  const TrunkMotion& motion() const { return motion_; }
  const Eigen::Vector3d& gyro_bias_radps() const { return gyro_bias_; }
  const Eigen::Vector3d& accel_bias_mps2() const { return accel_bias_; }
  Eigen::Vector3d up_in_body() const { return motion_.T_odom_body.rotation.conjugate() * Eigen::Vector3d::UnitZ(); }

  /// Returns the yaw rate about the z axis of odom.
  double yaw_rate_radps() const { return (motion_.T_odom_body.rotation * motion_.omega_body).z(); }

  /// Error covariance. Rows and columns: position in odom, rotation in odom, velocity in body, gyro bias, accelerometer
  /// bias.
  using Covariance = Eigen::Matrix<double, 15, 15>;
  static constexpr int kPosition = InertialError::kPosition, kRotation = InertialError::kRotation,
                       kVelocity = InertialError::kVelocity, kGyroBias = InertialError::kGyroBias,
                       kAccelBias = InertialError::kAccelBias;
  const Covariance& covariance() const { return P_; }
  /// Returns the covariance of x, y, yaw in odom.
  Eigen::Matrix3d planar_covariance() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(settings_, motion_, gyro_bias_, accel_bias_, last_, P_);
  }

 private:
  using Gain = Eigen::Matrix<double, 15, 3>;
  void add_dead_reckoning_noise(double dt_s);
  void apply_error(const Eigen::Matrix<double, 15, 1>& error);
  /// Corrects the state, and P by -W S^-1 W^T, where W = P H^T.
  void apply(const Gain& W, const Eigen::Matrix3d& S_inverse, const Eigen::Vector3d& innovation);

  Settings settings_;
  TrunkMotion motion_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_ = Eigen::Vector3d::Zero();
  InertialSample last_;
  Covariance P_ = Covariance::Zero();
};

}  // namespace patrol::localize
