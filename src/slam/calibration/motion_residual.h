#pragma once

#include <Eigen/Core>

#include "slam/calibration/motion_pairs.h"
#include "slam/motion_model.h"

namespace patrol::slam {

/// lidar_x_m, lidar_y_m, lidar_yaw_rad, distance_scale, turn_scale, steering_rad_per_m of a Calibration.
using CalibrationVector = Eigen::Matrix<double, 6, 1>;

/// How far a stretch is from what a calibration says of it.
struct MotionResidual {
  Eigen::Vector3d error;                  ///< x, y, yaw of odometry foretold less recorded, in the body at the stretch's begin
  Eigen::Matrix<double, 3, 6> jacobian;  ///< by CalibrationVector
  Eigen::Matrix3d lidar_covariance, odometry_covariance;  ///< of the error, before the latter is scaled

  Eigen::Matrix3d covariance(double move_noise, double turn_noise) const {
    const Eigen::Vector3d noise(move_noise, move_noise, turn_noise);
    return lidar_covariance + noise.asDiagonal() * odometry_covariance * noise.asDiagonal();
  }
};

/// X L X^-1 is the body's motion where L is the lidar's and X the lidar's place; of that, step by step, what odometry would make. `odometry`: how its errors
/// grow.
MotionResidual motion_residual(const MotionPair& pair, const CalibrationVector& parameters, const MotionModelSettings& odometry);

}  // namespace patrol::slam
