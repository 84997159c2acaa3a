#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/calibration/calibration_estimate.h"

namespace patrol::localize {

/// Biases of an IMU as an inertial filter estimates them, in body.
struct ImuBiases {
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero(), accel_mps2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyro_covariance = Eigen::Matrix3d::Zero(), accel_covariance = Eigen::Matrix3d::Zero();
};

/// Errors of the biases that the covariance of an inertial filter does not contain.
struct ImuBiasErrors {
  double gyro_systematic_std_radps = 0.0;
  double accel_systematic_std_mps2 = 0.0;
  double accel_filter_prior_std_mps2 = 0.0;  ///< prior standard deviation in the filter
  double accel_prior_std_mps2 = 0.0;         ///< standard deviation of the bias at power-on by the data sheet
  double accel_scale_std = 0.0;              ///< scale of the accelerometer, a bias of gravity times its error
};

/// Returns the biases of the gyro about x and y and of the accelerometer, in the axes of the sensor, by the names of
/// `kCalibrationParameters`. The bias about the vertical is that of scan matching (calibration/online_calibrator.h).
///
/// A filter whose prior of the accelerometer bias is tighter than the data sheet pulls the bias to zero by the ratio
/// P / P0 of its variance to its prior, where it has not measured the bias: on level ground, along x and y. The
/// remaining error is P + (P / P0)^2 (sheet^2 - P0). `up_in_body`: direction of gravity's reaction.
std::vector<CalibrationValue> imu_calibration(const ImuBiases& in_body, const ImuBiasErrors& errors,
                                              const Eigen::Quaterniond& R_body_imu, const Eigen::Vector3d& up_in_body);

}  // namespace patrol::localize
