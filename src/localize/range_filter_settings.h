#pragma once

#include <vector>

#include "core/settings.h"
#include "core/uwb.h"

namespace patrol::localize {

/// Settings of the localization by odometry and UWB ranges (range_filter.h).
struct RangeFilterSettings {
  // UWB ranges.
  /// Strictly increasing distances of the entries of `bias_m`; both lists empty: no bias.
  std::vector<double> bias_distance_m = UwbCalibration{}.distance_m;
  /// Bias of a line-of-sight range at each distance of `bias_distance_m`, interpolated linearly; both lists empty: no
  /// bias.
  std::vector<double> bias_m = UwbCalibration{}.bias_m;
  double range_std_m = 0.1;       ///< standard deviation of a line-of-sight range
  double nlos_probability = 0.3;  ///< prior probability of a non-line-of-sight (NLOS) range
  double nlos_bias_m = 0.5;       ///< mean bias of non-line-of-sight (NLOS) ranges
  /// Minimum line-of-sight probability of an accepted range; ranges below it are too long.
  double min_los_probability = 0.1;
  /// Maximum deviation of an accepted range that is too short, in standard deviations of the innovation; 3.3: 99.9 %.
  double negative_gate_sigma = 3.3;
  // Odometry. The standard deviations of its errors are part of its output; here are their correlation lengths and
  // white noise.
  double longitudinal_correlation_m = 8.0;  ///< correlation length of the longitudinal error of odometry: scale, slip
  double lateral_correlation_m = 4.0;       ///< correlation length of the lateral error of odometry
  /// Correlation time of the yaw error of odometry: gyro bias, from one standstill to the next.
  double yaw_correlation_s = 300.0;
  double position_random_walk_m_per_sqrt_m = 0.003;  ///< random walk of the position over the distance traveled
  double yaw_random_walk_rad_per_sqrt_s = 3.5e-4;    ///< random walk of the yaw over time
  double yaw_random_walk_rad_per_sqrt_rad = 0.002;   ///< random walk of the yaw over the rotation
  double height_std_m_per_sqrt_m = 0.02;  ///< random walk of the height of the body over the distance traveled
  double start_height_std_m = 0.05;       ///< standard deviation of the height of the body at the start
  // Recovery from a wrong estimate.
  int window = 30;  ///< number of the newest ranges over which rejections are counted
  /// Minimum ratio of accepted ranges in the window, below which the covariance is inflated.
  double min_accepted_ratio = 0.4;
  double reset_std_m = 0.5;     ///< standard deviation added to x and y when the covariance is inflated
  double reset_std_rad = 0.05;  ///< standard deviation added to the yaw when the covariance is inflated

  UwbCalibration calibration() const {
    return {.distance_m = bias_distance_m, .bias_m = bias_m, .range_std_m = range_std_m};
  }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("bias_distance_m", self.bias_distance_m, between(0.0, 1000.0));
    visit("bias_m", self.bias_m, between(-10.0, 10.0));
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("nlos_probability", self.nlos_probability, between(0.0, 0.99));
    visit("nlos_bias_m", self.nlos_bias_m, between(1e-3, 100.0));
    visit("min_los_probability", self.min_los_probability, between(0.0, 1.0));
    visit("negative_gate_sigma", self.negative_gate_sigma, between(0.1, 100.0));
    visit("longitudinal_correlation_m", self.longitudinal_correlation_m, between(0.01, 1e4));
    visit("lateral_correlation_m", self.lateral_correlation_m, between(0.01, 1e4));
    visit("yaw_correlation_s", self.yaw_correlation_s, between(0.1, 1e6));
    visit("position_random_walk_m_per_sqrt_m", self.position_random_walk_m_per_sqrt_m, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_s", self.yaw_random_walk_rad_per_sqrt_s, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 1.0));
    visit("height_std_m_per_sqrt_m", self.height_std_m_per_sqrt_m, between(0.0, 1.0));
    visit("start_height_std_m", self.start_height_std_m, between(0.0, 10.0));
    visit("window", self.window, between(5, 1000));
    visit("min_accepted_ratio", self.min_accepted_ratio, between(0.0, 1.0));
    visit("reset_std_m", self.reset_std_m, between(0.0, 100.0));
    visit("reset_std_rad", self.reset_std_rad, between(0.0, 3.0));
  }
};

}  // namespace patrol::localize
