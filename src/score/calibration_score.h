#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "core/calibration/calibration_estimate.h"
#include "core/ground_truth.h"
#include "core/trajectory.h"

/// Evaluation of the calibration that the robot estimates while it drives.
namespace patrol::score {

/// Angular velocity by the gyro in the frame of the IMU.
struct GyroReading {
  Time stamp{};
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
};

/// Recorded motion of a run, in the order of the stamps.
struct CalibrationRecord {
  const Trajectory& T_odom_body;
  const Trajectory& T_world_body;  ///< ground truth
  const std::vector<GyroReading>& gyro;
  const AsBuiltTruth& as_built;
  const std::vector<Time>& kidnaps;  ///< segments across them are not evaluated
};

/// Knowledge about a run that its log does not contain.
struct CalibrationReferences {
  Eigen::Quaterniond R_body_imu = Eigen::Quaterniond::Identity();  ///< nominal mount
  /// Offset that faults add to the lidar's stamps at an instant, s; empty without faults.
  std::function<double(Time)> lidar_clock_fault_s;
};

/// Estimated calibration parameter and its true value.
struct ScoredParameter {
  std::string name;
  double value = 0.0, std = 0.0;  ///< estimate
  double truth = 0.0;

  double error() const { return value - truth; }
  /// Returns whether the 95 % interval of the estimate contains the true value.
  bool holds() const;
};

/// Returns the true values of the calibration parameters at an instant, by the names of the estimates.
///
/// Time offset, drift, lidar yaw and antenna delays are the drawn ones. The scales of odometry, and bias and scale of
/// the gyro, are fitted to the ground truth over segments as in localize/calibration/odometry_calibrator.h: they depend
/// on slip, on warming and on the attitude, and have no drawn value. Parameters that cannot be fitted are left out.
std::vector<std::pair<std::string, double>> calibration_truth(const CalibrationRecord& record,
                                                              const CalibrationReferences& references, Time stamp);

/// Returns the estimates that have a true value, in the order of the estimate.
std::vector<ScoredParameter> calibration_score(const CalibrationEstimate& estimate,
                                               const std::vector<std::pair<std::string, double>>& truth);

}  // namespace patrol::score
