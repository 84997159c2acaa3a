#include "localize/imu_calibration.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "localize/inertial_motion.h"

namespace patrol::localize {
namespace {

double total_accel_std(double variance, double gravity_mps2, const ImuBiasErrors& errors) {
  const double prior = errors.accel_filter_prior_std_mps2 * errors.accel_filter_prior_std_mps2;
  const double excess = std::max(0.0, errors.accel_prior_std_mps2 * errors.accel_prior_std_mps2 - prior);
  const double unmeasured = prior > 0.0 ? std::min(1.0, variance / prior) : 1.0;
  return std::hypot(std::sqrt(variance + unmeasured * unmeasured * excess), errors.accel_scale_std * gravity_mps2,
                    errors.accel_systematic_std_mps2);
}

}  // namespace

std::vector<CalibrationValue> imu_calibration(const ImuBiases& in_body, const ImuBiasErrors& errors,
                                              const Eigen::Quaterniond& R_body_imu, const Eigen::Vector3d& up_in_body) {
  using enum CalibrationParameter;
  const Eigen::Matrix3d R = R_body_imu.toRotationMatrix().transpose();
  const Eigen::Vector3d gyro = R * in_body.gyro_radps, accel = R * in_body.accel_mps2;
  const Eigen::Vector3d gyro_variance = (R * in_body.gyro_covariance * R.transpose()).diagonal();
  const Eigen::Vector3d accel_variance = (R * in_body.accel_covariance * R.transpose()).diagonal();
  const Eigen::Vector3d gravity_mps2 = kGravity_mps2 * (R * up_in_body);
  std::vector<CalibrationValue> values;
  const auto add = [&](CalibrationParameter parameter, double value, double std) {
    values.push_back({.name = std::string(name_of(parameter)), .value = value, .std = std});
  };
  add(kGyroXBias, gyro.x(), std::hypot(std::sqrt(gyro_variance.x()), errors.gyro_systematic_std_radps));
  add(kGyroYBias, gyro.y(), std::hypot(std::sqrt(gyro_variance.y()), errors.gyro_systematic_std_radps));
  constexpr CalibrationParameter kAccel[3] = {kAccelXBias, kAccelYBias, kAccelZBias};
  for (int axis = 0; axis < 3; ++axis)
    add(kAccel[axis], accel[axis], total_accel_std(accel_variance[axis], gravity_mps2[axis], errors));
  return values;
}

}  // namespace patrol::localize
