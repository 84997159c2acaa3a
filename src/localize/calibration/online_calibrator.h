#pragma once

#include <optional>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "localize/calibration/anchor_delay_estimator.h"
#include "localize/calibration/gyro_yaw.h"
#include "localize/calibration/odometry_calibrator.h"
#include "localize/calibration/online_calibrator_settings.h"
#include "localize/calibration/scan_motion.h"
#include "localize/calibration/time_offset_estimator.h"

namespace patrol::localize {

/// Corrections that are applied to a scan before it is leveled.
struct ScanCorrection {
  double time_offset_s = 0.0;  ///< subtracted from the stamp
  double lidar_yaw_rad = 0.0;  ///< added to the yaw of the lidar in the body
};

/// Calibration of the robot while it drives, from its scans, odometry and gyro alone.
///
/// The estimates are applied to the following scans once their standard deviations are small, and smoothly, so that the
/// pose does not jump. They refer to the uncorrected scans: applied corrections are accounted for.
class OnlineCalibrator {
 public:
  OnlineCalibrator(const OnlineCalibratorSettings& settings, const Pose3& T_body_lidar, const Pose3& T_body_imu,
                   const std::vector<UwbAnchor>& anchors_in_map, const UwbCalibration& uwb);

  /// Adds a gyro reading; `R_odom_body` is the attitude at its stamp.
  void add(const Imu& imu, const Eigen::Quaterniond& R_odom_body) { gyro_.add(imu, R_odom_body); }
  void add(const LocatedRange& range) { anchor_delays_.add(range); }
  /// Returns the corrections of the scan with this stamp. Call once per scan, before it is leveled.
  ScanCorrection next_correction(Time stamp);
  /// Adds a scan that was leveled with the corrections of `sweep`.
  void add(const LevelScan& scan, const ScanSweep& sweep);

  /// Returns a new measurement of the gyro bias about the vertical, for odometry; none if there is none since the last
  /// call, or if the setting excludes it.
  std::optional<ScalarEstimate> take_gyro_bias() {
    return settings_.corrects_gyro_bias ? odometry_.take_recent_gyro_bias() : std::nullopt;
  }

  TimeOffset time_offset(Time stamp) const { return time_offset_.at(stamp); }
  /// Returns how many times the time offset has changed by a step.
  int num_time_offset_steps() const { return time_offset_.num_steps(); }
  CalibrationEstimate estimate(Time stamp) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(scan_motion_, time_offset_, odometry_, gyro_, anchor_delays_, applied_, corrected_);
  }

 private:
  OnlineCalibratorSettings settings_;
  ScanMotion scan_motion_;
  TimeOffsetEstimator time_offset_;
  OdometryCalibrator odometry_;
  GyroYaw gyro_;
  AnchorDelayEstimator anchor_delays_;
  ScanCorrection applied_;
  std::optional<Time> corrected_;  ///< stamp of the last corrected scan
};

}  // namespace patrol::localize
