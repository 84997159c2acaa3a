#pragma once

#include "core/settings.h"
#include "localize/calibration/anchor_delay_estimator_settings.h"
#include "localize/calibration/odometry_calibrator_settings.h"
#include "localize/calibration/scan_motion_settings.h"
#include "localize/calibration/time_offset_estimator_settings.h"

namespace patrol::localize {

/// Settings of the calibration while the robot drives, and of the use of its estimates.
struct OnlineCalibratorSettings {
  bool enabled = true;               ///< use of the calibration while the robot drives
  bool corrects_time_offset = true;  ///< use of the estimated time offset in the leveling of scans
  bool corrects_lidar_yaw = true;    ///< use of the estimated lidar yaw in the leveling of scans
  bool corrects_gyro_bias = true;    ///< use of the gyro bias by scan matching in odometry
  /// Maximum standard deviation of an applied time offset. A less certain offset is applied if it differs from the
  /// present one by more than five standard deviations.
  double max_applied_std_s = 0.002;
  double max_applied_std_rad = 0.0025;      ///< maximum standard deviation of an applied lidar yaw
  double max_offset_change_s_per_s = 0.05;  ///< maximum rate of change of the applied time offset
  double max_yaw_change_rad_per_s = 0.001;  ///< maximum rate of change of the applied lidar yaw
  double period_s = 1.0;                    ///< interval between published estimates of the calibration
  ScanMotionSettings scan_motion;
  TimeOffsetEstimatorSettings time_offset;
  OdometryCalibratorSettings odometry;
  AnchorDelayEstimatorSettings anchor_delays;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("corrects_time_offset", self.corrects_time_offset);
    visit("corrects_lidar_yaw", self.corrects_lidar_yaw);
    visit("corrects_gyro_bias", self.corrects_gyro_bias);
    visit("max_applied_std_s", self.max_applied_std_s, at_least(0.0));
    visit("max_applied_std_rad", self.max_applied_std_rad, at_least(0.0));
    visit("max_offset_change_s_per_s", self.max_offset_change_s_per_s, between(1e-6, 10.0));
    visit("max_yaw_change_rad_per_s", self.max_yaw_change_rad_per_s, between(1e-9, 1.0));
    visit("period_s", self.period_s, between(0.05, 3600.0));
    visit("scan_motion", self.scan_motion);
    visit("time_offset", self.time_offset);
    visit("odometry", self.odometry);
    visit("anchor_delays", self.anchor_delays);
  }
};

}  // namespace patrol::localize
