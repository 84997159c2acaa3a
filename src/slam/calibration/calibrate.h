#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

#include "core/settings.h"
#include "slam/calibration/motion_pairs.h"
#include "slam/motion_model.h"

namespace patrol::slam {

struct CalibratorSettings {
  int min_stretches = 20;  ///< fewer say nothing
  /// How odometry's errors grow with a stretch; how large they are at all is found from the log.
  MotionModelSettings odometry{.along_std_m_per_m = 0.02,
                               .across_std_m_per_m = 0.02,
                               .turn_std_rad_per_rad = 0.03,
                               .turn_std_rad_per_m = 0.01,
                               .turn_std_rad_per_s = 0.0,
                               .min_std_m = 0.003,
                               .min_std_rad = 0.002};
  double outlier_std = 5.0;  ///< a stretch that is so many standard deviations off is none of odometry's ordinary errors
  int max_iterations = 100;
  // What would be known less well than this is not taken from the log.
  double max_std_lidar_m = 0.05;
  double max_std_lidar_rad = 0.02;
  double max_std_distance_scale = 0.02;
  double max_std_turn_scale = 0.05;
  double max_std_steering_rad_per_m = 0.01;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_stretches", self.min_stretches, between(6, 1e6));
    visit("odometry", self.odometry);
    visit("outlier_std", self.outlier_std, between(3.0, 100.0));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("max_std_lidar_m", self.max_std_lidar_m, at_least(0.0));
    visit("max_std_lidar_rad", self.max_std_lidar_rad, at_least(0.0));
    visit("max_std_distance_scale", self.max_std_distance_scale, at_least(0.0));
    visit("max_std_turn_scale", self.max_std_turn_scale, at_least(0.0));
    visit("max_std_steering_rad_per_m", self.max_std_steering_rad_per_m, at_least(0.0));
  }
};

/// In the order of CalibrationResult::parameters; named as in Calibration.
inline constexpr std::array<const char*, 6> kCalibrationParameters = {"lidar_x_m",      "lidar_y_m",  "lidar_yaw_rad",
                                                                      "distance_scale", "turn_scale", "steering_rad_per_m"};

struct CalibratedParameter {
  double before = 0.0;  ///< as the log has it
  double value = 0.0;   ///< the same, when it is not observable
  double std = 0.0;     ///< of what the log says; a large one when that is next to nothing
  bool is_observable = false;
};

struct CalibrationResult {
  std::array<CalibratedParameter, 6> parameters;
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  ///< of the observable ones; zero elsewhere
  int num_stretches = 0;
  int num_rejected = 0;          ///< of these: odometry slipped or lied, or the match was wrong
  std::vector<double> errors;    ///< [stretch], standard deviations
  double move_noise = 0.0;       ///< odometry's errors over those of CalibratorSettings::odometry
  double turn_noise = 0.0;
  int iterations = 0;
  bool converged = false;

  /// The lidar's place is given if any of it was observable.
  Calibration calibration() const;
};

/// The lidar's place in the body and odometry's scales that let the stretches agree: hand-eye calibration in the plane, X L = B X with L the lidar's motion
/// and B the body's (Censi et al. 2013, section III, with what odometry says of B on the other side of the equation).
///
/// - The residual is odometry as the lidar's motion foretells it less odometry as recorded. Odometry errs far more than matching does, and an error of what is
///   explained shrinks no scale, as one of what explains would (errors in variables).
/// - Gauss-Newton, reweighted: Cauchy's weights at first, then Tukey's biweight, which gives no weight to what is far off: wheels that spin, logs that say
///   forwards for backwards. The size of odometry's errors, of moves and of turns, is estimated on the way (median of the absolute residuals).
/// - A parameter that the log would tell worse than the settings ask keeps its value and takes no part; the worst goes first. A way without turns does not
///   tell the lever arm, and a circle does not tell steering from the scale of turns: then the second is right if the first is.
/// - Standard deviations come from the scores of runs of stretches, so that they hold also where errors last longer than a stretch (White's sandwich, in
///   clusters); where the log has fewer than twenty runs, from the curvature alone. They know nothing
///   of odometry that errs otherwise than by these numbers: where it does, stretches of other lengths give other numbers.
///
/// Not estimated: the lidar's own scale, with which odometry's is compared, and a difference of the two clocks: at a steady speed scans that are stamped late by
/// dt look like a lidar that sits speed * dt farther back.
///
/// Throws InputError for fewer than `min_stretches`.
CalibrationResult calibrate(const std::vector<MotionPair>& pairs, const Pose2& T_body_lidar_before, const CalibratorSettings& settings);

}  // namespace patrol::slam
