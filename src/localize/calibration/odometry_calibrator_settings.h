#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the estimation of lidar yaw and odometry scales.
struct OdometryCalibratorSettings {
  double segment_m = 1.0;                   ///< distance after which a segment of the compared motions ends
  double segment_rad = 0.5;                 ///< rotation after which a segment of the compared motions ends
  double segment_s = 10.0;                  ///< duration after which a segment of the compared motions ends
  double prior_lidar_yaw_std_rad = 0.02;    ///< prior standard deviation of the lidar's mounting yaw
  double prior_distance_scale_std = 0.03;   ///< prior standard deviation of the distance scale of odometry
  double prior_rotation_scale_std = 0.02;   ///< prior standard deviation of the rotation scale of odometry
  double prior_gyro_bias_std_radps = 0.01;  ///< prior standard deviation of the gyro bias
  double prior_gyro_scale_std = 0.02;       ///< prior standard deviation of the gyro scale
  double odometry_std_m_per_m = 0.01;       ///< nominal standard deviation of the position of odometry per distance
  double odometry_std_rad_per_m = 0.001;    ///< nominal standard deviation of the yaw of odometry per distance
  double odometry_std_rad_per_rad = 0.002;  ///< nominal standard deviation of the yaw of odometry per rotation
  double gyro_std_rad_per_sqrt_s = 3e-4;    ///< nominal standard deviation of the integrated gyro rate
  /// Interval between the measurements of the gyro bias by scan matching that odometry uses.
  double gyro_bias_interval_s = 5.0;
  /// Standard deviation of the direction of odometry's translation relative to the body, constant over a run: legs and
  /// tracks slip sideways systematically. Added to that of the lidar yaw, which cannot be separated from it.
  double lateral_bias_std_rad = 0.001;
  /// Standard deviation of the error of the distance scale that scan matching cannot separate.
  double distance_bias_std = 0.001;
  /// Standard deviation of the systematic error of the yaw rate by scan matching, which the gyro bias contains. Scans
  /// are not level, and walls are not vertical.
  double matched_rate_bias_std_radps = 0.0007;
  /// Standard deviation of the relative systematic error of the rotation by scan matching, which the gyro scale
  /// contains.
  double matched_rotation_bias_std = 0.002;
  double outlier_sigma = 4.0;  ///< maximum residual of an accepted segment, in standard deviations

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("segment_m", self.segment_m, between(0.05, 100.0));
    visit("segment_rad", self.segment_rad, between(0.05, 3.0));
    visit("segment_s", self.segment_s, between(0.5, 1000.0));
    visit("prior_lidar_yaw_std_rad", self.prior_lidar_yaw_std_rad, between(1e-6, 1.0));
    visit("prior_distance_scale_std", self.prior_distance_scale_std, between(1e-6, 1.0));
    visit("prior_rotation_scale_std", self.prior_rotation_scale_std, between(1e-6, 1.0));
    visit("prior_gyro_bias_std_radps", self.prior_gyro_bias_std_radps, between(1e-9, 1.0));
    visit("prior_gyro_scale_std", self.prior_gyro_scale_std, between(1e-6, 1.0));
    visit("odometry_std_m_per_m", self.odometry_std_m_per_m, between(1e-6, 1.0));
    visit("odometry_std_rad_per_m", self.odometry_std_rad_per_m, between(0.0, 1.0));
    visit("odometry_std_rad_per_rad", self.odometry_std_rad_per_rad, between(0.0, 1.0));
    visit("gyro_std_rad_per_sqrt_s", self.gyro_std_rad_per_sqrt_s, between(1e-9, 1.0));
    visit("lateral_bias_std_rad", self.lateral_bias_std_rad, between(0.0, 1.0));
    visit("matched_rate_bias_std_radps", self.matched_rate_bias_std_radps, between(0.0, 1.0));
    visit("matched_rotation_bias_std", self.matched_rotation_bias_std, between(0.0, 1.0));
    visit("distance_bias_std", self.distance_bias_std, between(0.0, 1.0));
    visit("gyro_bias_interval_s", self.gyro_bias_interval_s, between(0.1, 1000.0));
    visit("outlier_sigma", self.outlier_sigma, between(1.0, 100.0));
  }
};

}  // namespace patrol::localize
