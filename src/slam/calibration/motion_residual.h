#pragma once

#include <Eigen/Core>

#include "slam/calibration/motion_segments.h"
#include "slam/motion_model.h"

namespace patrol::slam {

/// Parameter vector: lidar_x_m, lidar_y_m, lidar_yaw_rad, distance_scale, rotation_scale, steering_bias_rad_per_m of a
/// Calibration.
using CalibrationVector = Eigen::Matrix<double, 6, 1>;

/// Difference between predicted and recorded odometry of a segment.
struct MotionResidual {
  /// Predicted minus recorded odometry: x, y, yaw in the body frame at the begin of the segment.
  Eigen::Vector3d error;
  Eigen::Matrix<double, 3, 6> jacobian;  ///< derivative with respect to CalibrationVector
  /// Covariances of the error; the odometry covariance before scaling.
  Eigen::Matrix3d lidar_covariance, odometry_covariance;

  Eigen::Matrix3d covariance(double translation_noise_scale, double rotation_noise_scale) const {
    const Eigen::Vector3d noise(translation_noise_scale, translation_noise_scale, rotation_noise_scale);
    return lidar_covariance + noise.asDiagonal() * odometry_covariance * noise.asDiagonal();
  }
};

/// Predicts the odometry of a segment from the lidar motion. X L X^-1 is the body motion, with L the lidar motion and X
/// the lidar pose. The inverse of the odometry correction is applied step by step. `odometry` is the noise model.
MotionResidual motion_residual(const MotionSegment& pair, const CalibrationVector& parameters,
                               const MotionModelSettings& odometry);

}  // namespace patrol::slam
