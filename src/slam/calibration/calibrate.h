#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/settings.h"
#include "slam/calibration/motion_segments.h"
#include "slam/motion_model.h"

namespace patrol::slam {

struct CalibratorSettings {
  int min_segments = 20;  ///< minimum number of segments
  /// Odometry noise model of a segment. Its scale is estimated from the log.
  MotionModelSettings odometry{.longitudinal_std_m_per_m = 0.02,
                               .lateral_std_m_per_m = 0.02,
                               .yaw_std_rad_per_rad = 0.03,
                               .yaw_std_rad_per_m = 0.01,
                               .yaw_std_rad_per_s = 0.0,
                               .min_std_m = 0.003,
                               .min_std_rad = 0.002};
  double outlier_sigma = 5.0;  ///< segments with larger errors, in standard deviations, are outliers of odometry
  int max_iterations = 100;
  // Parameters with a larger standard deviation are not estimated; with the limit 0, never.
  double max_std_lidar_m = 0.05;
  double max_std_lidar_rad = 0.02;
  double max_std_distance_scale = 0.02;
  double max_std_rotation_scale = 0.05;
  double max_std_steering_bias_rad_per_m = 0.01;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_segments", self.min_segments, between(6, 1e6));
    visit("odometry", self.odometry);
    visit("outlier_sigma", self.outlier_sigma, between(3.0, 100.0));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("max_std_lidar_m", self.max_std_lidar_m, at_least(0.0));
    visit("max_std_lidar_rad", self.max_std_lidar_rad, at_least(0.0));
    visit("max_std_distance_scale", self.max_std_distance_scale, at_least(0.0));
    visit("max_std_rotation_scale", self.max_std_rotation_scale, at_least(0.0));
    visit("max_std_steering_bias_rad_per_m", self.max_std_steering_bias_rad_per_m, at_least(0.0));
  }
};

/// Parameter names as in Calibration, in the order of CalibrationResult::parameters.
inline constexpr std::array<const char*, 6> kCalibrationParameters = {
    "lidar_x_m", "lidar_y_m", "lidar_yaw_rad", "distance_scale", "turn_scale", "steering_rad_per_m"};

struct CalibratedParameter {
  double before = 0.0;  ///< value in the log
  double value = 0.0;   ///< estimate; equals `before` if not observable
  double std = 0.0;     ///< standard deviation from the log; large if the log does not constrain the parameter
  bool is_observable = false;
};

struct CalibrationResult {
  std::array<CalibratedParameter, 6> parameters;
  /// Covariance of the observable parameters; zero elsewhere.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int num_segments = 0;
  int num_rejected = 0;        ///< number of rejected segments: odometry outliers or wrong matches
  std::vector<double> errors;  ///< [segment], standard deviations
  double translation_noise_scale =
      0.0;  ///< scale of the translational odometry noise relative to CalibratorSettings::odometry
  double rotation_noise_scale = 0.0;
  int iterations = 0;
  bool converged = false;

  /// Returns the calibration; it overrides the lidar pose if any component of it is observable.
  Calibration calibration() const;
};

/// Estimates the lidar pose in the body and the odometry parameters from segments. Planar hand-eye calibration: X L = B
/// X with L the lidar motion and B the body motion [Censi13, section III].
///
/// - Deviation from [Censi13]: the residual is the odometry predicted from the lidar motion minus the recorded
///   odometry. Odometry has much larger errors than matching. Errors of the dependent variable do not bias a scale, as
///   those of the independent variable would (errors in variables).
/// - Iteratively reweighted Gauss-Newton: first with Cauchy weights, then with Tukey's biweight, which gives outliers
///   no weight (wheel slip, logs with reversed direction). The scales of the translational and rotational odometry
///   noise are estimated in each iteration (median of the absolute residuals).
/// - A parameter whose standard deviation exceeds the limit of the settings keeps its value and is excluded, the worst
///   first. Without rotation, the lever arm is unobservable. On a circle, steering and rotation scale cannot be
///   separated: the rotation scale is then correct only if the steering is.
/// - Standard deviations follow from the scores of groups of consecutive segments, and thus also hold for errors longer
///   than a segment (White's sandwich estimator, clustered). With fewer than twenty groups they follow from the
///   curvature alone. They do not cover odometry errors outside the model; in that case segments of other lengths give
///   different results.
///
/// Not estimated: the scale of the lidar, which is the reference for the odometry, and the offset between the two
/// clocks. At constant speed, scans stamped late by dt are equivalent to a lidar mounted speed * dt farther back.
///
/// Throws InputError for fewer than `min_segments` segments.
CalibrationResult calibrate(const std::vector<MotionSegment>& pairs, const Pose2& T_body_lidar_before,
                            const CalibratorSettings& settings);

}  // namespace patrol::slam
