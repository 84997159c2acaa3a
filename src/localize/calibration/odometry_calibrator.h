#pragma once

#include <optional>
#include <utility>

#include "localize/calibration/calibration_scan.h"
#include "localize/calibration/clustered_least_squares.h"
#include "localize/calibration/odometry_calibrator_settings.h"

namespace patrol::localize {

/// Estimate of a scalar parameter.
struct ScalarEstimate {
  double value = 0.0, std = 0.0;
};

/// Estimator of the yaw of the lidar in the body and of the scales of odometry and gyro, from the motion over segments
/// of about a meter: planar hand-eye calibration as in slam/calibration/calibrate.h, linearized and recursive.
///
/// The reference is scan matching. The lidar yaw is the difference between the directions of travel by matching and by
/// odometry; it is defined by the heading of odometry.
class OdometryCalibrator {
 public:
  /// `p_body_lidar`: nominal position of the lidar in level.
  OdometryCalibrator(const OdometryCalibratorSettings& settings, const Eigen::Vector2d& p_body_lidar);

  /// Adds a matched scan. `time_offset_s`: present estimate of the time offset. `gyro_yaw_rad`: gyro rate about the
  /// vertical, integrated up to the stamp of the scan; none if it is unknown.
  void add(const CalibrationScan& scan, double time_offset_s, std::optional<double> gyro_yaw_rad);
  /// Ends the present segment without using it.
  void interrupt();

  ScalarEstimate lidar_yaw_rad() const;
  ScalarEstimate distance_scale() const;
  ScalarEstimate rotation_scale() const;
  ScalarEstimate gyro_bias_radps() const;
  ScalarEstimate gyro_scale() const;
  /// Returns the mean bias of the gyro about the vertical over the last seconds, once for each interval. Biases that
  /// are constant, like `gyro_bias_radps`, do not hold for a sensor that warms up.
  std::optional<ScalarEstimate> take_recent_gyro_bias() { return std::exchange(recent_gyro_bias_, std::nullopt); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(odometry_, gyro_, begin_, gyro_drift_, recent_gyro_bias_);
  }

 private:
  struct SegmentBegin {
    CalibrationScan scan;
    std::optional<double> gyro_yaw_rad;
  };
  /// Rotation by the gyro minus that by the matches over consecutive segments.
  struct GyroDrift {
    double yaw_rad = 0.0, variance_rad2 = 0.0;
    double turned_rad = 0.0;
    double elapsed_s = 0.0;
  };
  void add_odometry(const SegmentBegin& begin, const CalibrationScan& end, double time_offset_s);
  void add_gyro(const SegmentBegin& begin, const CalibrationScan& end, double gyro_yaw_rad, double time_offset_s);

  OdometryCalibratorSettings settings_;
  Eigen::Vector2d p_body_lidar_;
  ClusteredLeastSquares odometry_;  ///< lidar yaw, distance scale - 1, rotation scale - 1
  ClusteredLeastSquares gyro_;      ///< bias, scale - 1
  std::optional<SegmentBegin> begin_;
  GyroDrift gyro_drift_;
  std::optional<ScalarEstimate> recent_gyro_bias_;
};

}  // namespace patrol::localize
