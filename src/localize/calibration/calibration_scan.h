#pragma once

#include "core/time.h"
#include "localize/calibration/scan_motion.h"

namespace patrol::localize {

/// Odometry over the sweep of a scan, with the corrections that were applied when the scan was leveled.
struct ScanSweep {
  Time stamp{};  ///< corrected stamp of the last beam
  double duration_s = 0.0;
  Pose2 T_odom_begin, T_odom_end;      ///< level pose at the first and the last beam
  double applied_time_offset_s = 0.0;  ///< subtracted from the stamp
  double applied_lidar_yaw_rad = 0.0;  ///< added to the yaw of the lidar in the body

  /// Returns the mean velocity over the sweep: x, y in odom and yaw rate; m/s, rad/s.
  Eigen::Vector3d velocity() const {
    return Eigen::Vector3d(T_odom_end.x - T_odom_begin.x, T_odom_end.y - T_odom_begin.y,
                           wrap_angle(T_odom_end.yaw - T_odom_begin.yaw)) /
           duration_s;
  }
};

/// Matched scan with the odometry over its sweep.
struct CalibrationScan {
  ScanSweep sweep;
  MatchedScan match;
};

/// Motion between two matched scans of one local map, by matching and by odometry.
struct CalibrationStep {
  Pose2 T_before_now_match, T_before_now_odom;
  /// Motion of the matches minus motion of odometry, in level of the first scan; m, m, rad.
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d match_covariance = Eigen::Matrix3d::Zero();  ///< covariance of the residual by the matches alone
  /// Derivative of the residual with respect to the time offset remaining at the first scan (minus this column) and at
  /// the second scan (plus that column).
  Eigen::Vector3d by_offset_before = Eigen::Vector3d::Zero(), by_offset_now = Eigen::Vector3d::Zero();
};

/// Compares the motion between two scans. Precondition: both are of one local map.
///
/// A scan stamped late by e is leveled with odometry from e later. Its points are then placed as by a robot whose pose
/// lags by e times the mean velocity over the sweep; the deskewing within the sweep cancels for constant velocity.
CalibrationStep compare(const CalibrationScan& before, const CalibrationScan& now);

}  // namespace patrol::localize
