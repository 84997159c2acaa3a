#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the estimation of the time offset of the lidar (time_offset_estimator.h).
struct TimeOffsetEstimatorSettings {
  double prior_std_s = 0.03;  ///< prior standard deviation of the time offset of the lidar
  /// Prior standard deviation of the drift of the time offset: crystal tolerance.
  double prior_drift_std_s_per_s = 3e-5;
  double odometry_std_m = 0.002;     ///< standard deviation of odometry's translation from scan to scan
  double odometry_std_rad = 0.0005;  ///< standard deviation of odometry's rotation from scan to scan
  /// Standard deviation of the lag of odometry behind its own stamps, which cannot be separated from the time offset of
  /// the lidar.
  double odometry_lag_std_s = 0.0015;
  /// Factor of the variance of the translations from scan to scan, whose errors follow the gait.
  double translation_variance_factor = 25;
  /// Standard deviation of the linearized effect of the part of the time offset that is not yet applied, relative to
  /// the effect.
  double linearization_error = 0.2;
  double max_gap_s = 0.3;       ///< maximum time between two scans that are compared
  double outlier_sigma = 4.0;   ///< maximum residual of an accepted comparison of two scans, in standard deviations
  double step_window_s = 10.0;  ///< time span of the newest scans that detect a step of the time offset
  double step_sigma = 6.0;      ///< minimum size of a detected step of the time offset, in standard deviations
  double min_step_s = 0.004;    ///< minimum size of a detected step of the time offset

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("prior_std_s", self.prior_std_s, between(1e-6, 1.0));
    visit("prior_drift_std_s_per_s", self.prior_drift_std_s_per_s, between(1e-9, 1e-2));
    visit("odometry_std_m", self.odometry_std_m, between(1e-6, 1.0));
    visit("odometry_std_rad", self.odometry_std_rad, between(1e-6, 1.0));
    visit("odometry_lag_std_s", self.odometry_lag_std_s, between(0.0, 1.0));
    visit("translation_variance_factor", self.translation_variance_factor, between(1.0, 1e12));
    visit("linearization_error", self.linearization_error, between(0.0, 10.0));
    visit("max_gap_s", self.max_gap_s, between(0.01, 10.0));
    visit("outlier_sigma", self.outlier_sigma, between(1.0, 100.0));
    visit("step_window_s", self.step_window_s, between(1.0, 1000.0));
    visit("step_sigma", self.step_sigma, between(1.0, 100.0));
    visit("min_step_s", self.min_step_s, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
