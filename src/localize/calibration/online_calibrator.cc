#include "localize/calibration/online_calibrator.h"

#include <algorithm>
#include <string>

namespace patrol::localize {
namespace {

/// Moves a value toward a target by at most `max_change`.
double toward(double value, double target, double max_change) {
  return value + std::clamp(target - value, -max_change, max_change);
}

CalibrationValue entry(CalibrationParameter parameter, const ScalarEstimate& estimate) {
  return {.name = std::string(name_of(parameter)), .value = estimate.value, .std = estimate.std};
}

}  // namespace

OnlineCalibrator::OnlineCalibrator(const OnlineCalibratorSettings& settings, const Pose3& T_body_lidar,
                                   const Pose3& T_body_imu, const std::vector<UwbAnchor>& anchors_in_map,
                                   const UwbCalibration& uwb)
    : settings_(settings),
      scan_motion_(settings.scan_motion),
      time_offset_(settings.time_offset),
      odometry_(settings.odometry, T_body_lidar.position.head<2>()),
      gyro_(T_body_imu.rotation),
      anchor_delays_(settings.anchor_delays, anchors_in_map, uwb) {}

ScanCorrection OnlineCalibrator::next_correction(Time stamp) {
  const double elapsed_s = corrected_ ? std::max(0.0, to_seconds(stamp - *corrected_)) : 0.0;
  corrected_ = stamp;
  const TimeOffset offset = time_offset_.at(stamp);
  if (settings_.corrects_time_offset && is_applicable(offset, applied_.time_offset_s, settings_.max_applied_std_s)) {
    applied_.time_offset_s =
        toward(applied_.time_offset_s, offset.value_s, settings_.max_offset_change_s_per_s * elapsed_s);
  }
  const ScalarEstimate yaw = odometry_.lidar_yaw_rad();
  if (settings_.corrects_lidar_yaw && yaw.std <= settings_.max_applied_std_rad) {
    applied_.lidar_yaw_rad = toward(applied_.lidar_yaw_rad, yaw.value, settings_.max_yaw_change_rad_per_s * elapsed_s);
  }
  return applied_;
}

void OnlineCalibrator::add(const LevelScan& scan, const ScanSweep& sweep) {
  const std::optional<MatchedScan> match = scan_motion_.add(scan, sweep.T_odom_end);
  if (!match) return odometry_.interrupt();
  const CalibrationScan matched{.sweep = sweep, .match = *match};
  time_offset_.add(matched);
  odometry_.add(matched, time_offset_.at(sweep.stamp).value_s, gyro_.at(sweep.stamp));
}

CalibrationEstimate OnlineCalibrator::estimate(Time stamp) const {
  using enum CalibrationParameter;
  const TimeOffset offset = time_offset_.at(stamp);
  CalibrationEstimate estimate{
      .stamp = stamp,
      .values = {entry(kLidarTimeOffset, {offset.value_s, offset.std_s}),
                 entry(kLidarClockDrift, {offset.drift_s_per_s, offset.drift_std_s_per_s}),
                 entry(kLidarYaw, odometry_.lidar_yaw_rad()), entry(kOdometryDistanceScale, odometry_.distance_scale()),
                 entry(kOdometryRotationScale, odometry_.rotation_scale()),
                 entry(kGyroZBias, odometry_.gyro_bias_radps()), entry(kGyroZScale, odometry_.gyro_scale())}};
  const std::vector<CalibrationValue> delays = anchor_delays_.delays();
  estimate.values.insert(estimate.values.end(), delays.begin(), delays.end());
  return estimate;
}

}  // namespace patrol::localize
