#pragma once

#include <functional>
#include <optional>
#include <string>
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

/// Counts of the two tracks since power-up.
struct TrackReading {
  Time stamp{};
  double left = 0.0, right = 0.0;
};

/// Recorded motion of a run, in the order of the stamps.
struct CalibrationRecord {
  const Trajectory& T_odom_body;
  const Trajectory& T_world_body;  ///< ground truth
  const std::vector<GyroReading>& gyro;
  const AsBuiltTruth& as_built;
  const std::vector<Time>& kidnaps;         ///< segments across them are not evaluated
  const std::vector<TrackReading>& tracks;  ///< empty for a robot without tracks
};

/// Knowledge about a run that its log does not contain.
struct CalibrationReferences {
  Eigen::Quaterniond R_body_imu = Eigen::Quaterniond::Identity();    ///< nominal mount
  Eigen::Quaterniond R_body_lidar = Eigen::Quaterniond::Identity();  ///< nominal mount
  /// Offset that faults add to the lidar's stamps at an instant, s; empty without faults.
  std::function<double(Time)> lidar_clock_fault_s;
};

/// True value of a calibration parameter.
struct TrueParameter {
  std::string name;
  double value = 0.0;
  double std = 0.0;                  ///< tolerance: standard deviation of a random walk that the log does not contain
  std::optional<double> drawn = {};  ///< drawn value of a related quantity, for information
};

/// Estimated calibration parameter and its true value.
struct ScoredParameter {
  std::string name;
  double value = 0.0, std = 0.0;  ///< estimate
  double truth = 0.0;
  double truth_std = 0.0;
  std::optional<double> drawn = {};

  double error() const { return value - truth; }
  /// Returns whether the 95 % interval of the estimate, widened by the tolerance of the truth, contains the true value.
  bool holds() const;
};

/// Returns the true values of the calibration parameters at an instant, by the names of the estimates.
///
/// Time offset, drift, lidar yaw and antenna delays are the drawn ones. The scales of odometry, and bias and scale of
/// the gyro, are fitted to the ground truth over segments as in localize/calibration/odometry_calibrator.h: they depend
/// on slip, on warming and on the attitude, and have no drawn value. Parameters that cannot be fitted are left out.
///
/// Other biases of the IMU are the drawn ones: at power-on, by warming and, for the gyro, by gravity on level ground.
/// Their random walk is not in the log; its standard deviation is the tolerance. The scale and the misalignment of the
/// sensor and its mount are not part of the truth.
///
/// The center of rotation is fitted to the ground truth, by least squares with weights that decrease by 1 / e over 2
/// rad of rotation before the instant: the lateral velocity is -x times the yaw rate, and the forward velocity a
/// multiple of the mean count rate of the tracks plus y times the yaw rate. `drawn` of the distance scale of a tracked
/// robot: mean pitch radius of its sprockets relative to the nominal one, without slip.
std::vector<TrueParameter> calibration_truth(const CalibrationRecord& record, const CalibrationReferences& references,
                                             Time stamp);

/// Returns the estimates that have a true value, in the order of the estimate.
std::vector<ScoredParameter> calibration_score(const CalibrationEstimate& estimate,
                                               const std::vector<TrueParameter>& truth);

}  // namespace patrol::score
