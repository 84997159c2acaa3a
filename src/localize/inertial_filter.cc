#include "localize/inertial_filter.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace patrol::localize {
namespace {

constexpr double kStartTiltStd_rad = 0.05;
constexpr double kStartVelocityStd_mps = 0.1;
constexpr double kGate = 16.27;  // 99.9 % of chi-square, three degrees of freedom
// Process noise without an IMU.
constexpr double kCoastYawRateStd = 0.05;  // rad/sqrt(s): yaw rate from the feet, including slip
constexpr double kCoastTiltStd = 0.15;     // rad/sqrt(s)
constexpr double kCoastVelocityStd = 1.0;  // m/s/sqrt(s)

}  // namespace

InertialFilter::InertialFilter(const Settings& settings, const InertialSample& first)
    : settings_(settings), last_(first) {
  motion_.T_odom_body.rotation = tilt_from_gravity(first.force_mps2);
  motion_.omega_body = first.rate_radps;
  const auto set_std = [this](int block, double std) { P_.diagonal().segment<3>(block).setConstant(std * std); };
  set_std(kRotation, kStartTiltStd_rad);
  P_(kRotation + 2, kRotation + 2) = 0.0;  // zero by definition of odom
  set_std(kVelocity, kStartVelocityStd_mps);
  set_std(kGyroBias, settings.gyro_bias_std_radps);
  set_std(kAccelBias, settings.accel_bias_std_mps2);
  correlate_start_tilt(P_, motion_.T_odom_body.rotation);
}

void InertialFilter::predict(double dt_s, const InertialSample& sample) {
  // Trapezoidal rule: the mean of the previous sample and this one applies to the step.
  const Eigen::Vector3d omega = 0.5 * (last_.rate_radps + sample.rate_radps) - gyro_bias_;
  const Eigen::Vector3d force = 0.5 * (last_.force_mps2 + sample.force_mps2) - accel_bias_;
  last_ = sample;

  const InertialStep step = integrate(motion_, dt_s, omega, force);
  motion_ = step.after;
  motion_.omega_body = sample.rate_radps - gyro_bias_;

  propagate_inertial_errors(P_, dt_s, step.R_odom_body, step.v_body, omega);
  const auto add_variance = [this](int block, double variance) { P_.diagonal().segment<3>(block).array() += variance; };
  add_variance(kRotation, dt_s * std::pow(settings_.gyro_noise_density_radps_per_sqrt_hz, 2));
  add_variance(kVelocity, dt_s * std::pow(settings_.accel_noise_density_mps2_per_sqrt_hz, 2));
  add_variance(kGyroBias, dt_s * std::pow(settings_.gyro_bias_random_walk_radps_per_sqrt_s, 2));
  add_variance(kAccelBias, dt_s * std::pow(settings_.accel_bias_random_walk_mps2_per_sqrt_s, 2));
  add_dead_reckoning_noise(dt_s);
}

void InertialFilter::coast(double dt_s, double yaw_rate_radps) {
  Pose3& T = motion_.T_odom_body;
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  T.position += dt_s * (R * motion_.v_body);
  T.rotation = (quaternion_from_yaw(dt_s * yaw_rate_radps) * T.rotation).normalized();
  motion_.omega_body = R.transpose() * Eigen::Vector3d(0.0, 0.0, yaw_rate_radps);
  last_ = {motion_.omega_body + gyro_bias_, kGravity_mps2 * R.transpose().col(2) + accel_bias_};

  propagate_inertial_errors(P_, dt_s, R, motion_.v_body, motion_.omega_body);
  P_.diagonal().segment<2>(kRotation).array() += dt_s * kCoastTiltStd * kCoastTiltStd;
  P_(kRotation + 2, kRotation + 2) += dt_s * kCoastYawRateStd * kCoastYawRateStd;
  P_.diagonal().segment<3>(kVelocity).array() += dt_s * kCoastVelocityStd * kCoastVelocityStd;
  add_dead_reckoning_noise(dt_s);
}

void InertialFilter::add_dead_reckoning_noise(double dt_s) {
  const double distance_m = dt_s * motion_.v_body.norm();
  const double turn_rad = dt_s * std::abs(motion_.omega_body.z());
  P_.diagonal().segment<3>(kPosition).array() += distance_m * std::pow(settings_.position_random_walk_m_per_sqrt_m, 2);
  P_(kRotation + 2, kRotation + 2) += turn_rad * std::pow(settings_.yaw_random_walk_rad_per_sqrt_rad, 2);
}

void InertialFilter::correct_velocity(const Eigen::Vector3d& innovation, const Eigen::Vector3d& p_contact,
                                      double variance) {
  const Eigen::Matrix3d lever = cross_matrix(p_contact);
  const Gain W = P_.middleCols<3>(kVelocity) + P_.middleCols<3>(kGyroBias) * lever.transpose();
  const Eigen::Matrix3d expected = W.middleRows<3>(kVelocity) + lever * W.middleRows<3>(kGyroBias);
  Eigen::Matrix3d S = expected;
  S.diagonal().array() += variance;
  Eigen::Matrix3d S_inverse = S.inverse();
  const double distance = innovation.dot(S_inverse * innovation);
  if (distance > kGate) {
    S.diagonal().array() += variance * (distance / kGate - 1.0);
    S_inverse = S.inverse();
  }
  apply(W, S_inverse, innovation);
}

void InertialFilter::correct_gyro_bias(const Eigen::Vector3d& bias_radps, const Eigen::Vector3d& variance) {
  const Gain W = P_.middleCols<3>(kGyroBias);
  Eigen::Matrix3d S = W.middleRows<3>(kGyroBias);
  S.diagonal() += variance;
  // Do not correct position and yaw for past bias errors, because odom must not jump. With rows of the gain set to
  // zero, the covariance update has Joseph's form (Schmidt's consider update).
  Gain K = W * S.inverse();
  K.middleRows<3>(kPosition).setZero();
  K.row(kRotation + 2).setZero();
  apply_error(K * (bias_radps - gyro_bias_));
  P_ += K * S * K.transpose() - K * W.transpose() - W * K.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

void InertialFilter::apply(const Gain& W, const Eigen::Matrix3d& S_inverse, const Eigen::Vector3d& innovation) {
  const Gain K = W * S_inverse;
  apply_error(K * innovation);
  P_.noalias() -= K * W.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

void InertialFilter::apply_error(const Eigen::Matrix<double, 15, 1>& error) {
  Pose3& T = motion_.T_odom_body;
  T.position += error.segment<3>(kPosition);
  T.rotation = (rotation_by(error.segment<3>(kRotation)) * T.rotation).normalized();
  motion_.v_body += error.segment<3>(kVelocity);
  gyro_bias_ += error.segment<3>(kGyroBias);
  accel_bias_ += error.segment<3>(kAccelBias);
  motion_.omega_body -= error.segment<3>(kGyroBias);
}

Eigen::Matrix3d InertialFilter::planar_covariance() const {
  constexpr int kIndex[3] = {kPosition, kPosition + 1, kRotation + 2};
  Eigen::Matrix3d planar;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) planar(row, col) = P_(kIndex[row], kIndex[col]);
  }
  return planar;
}

}  // namespace patrol::localize
