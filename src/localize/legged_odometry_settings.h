#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the legged odometry. The defaults fit a MEMS IMU of robotics grade and encoders at 250 Hz.
struct LeggedOdometrySettings {
  // IMU.
  double gyro_noise_density_radps_per_sqrt_hz = 2e-4;    ///< noise density of the gyro
  double gyro_bias_std_radps = 5e-3;                     ///< prior standard deviation of the gyro bias at power-on
  double gyro_bias_random_walk_radps_per_sqrt_s = 1e-5;  ///< random walk of the gyro bias
  /// Noise density of the accelerometer, with the aliasing of walking shocks.
  double accel_noise_density_mps2_per_sqrt_hz = 0.1;
  double accel_bias_std_mps2 = 0.05;  ///< prior standard deviation of the accelerometer bias in the filter
  double accel_bias_random_walk_mps2_per_sqrt_s = 1e-3;  ///< random walk of the accelerometer bias
  // Errors of the published biases beyond the covariance of the filter (imu_calibration.h). The filter takes the errors
  // of walking as white noise; the shocks of the gait and the motion of the feet bias it for minutes. Systematic
  // errors: root mean square at the end of street/patrol, seeds 11 to 14.
  /// Standard deviation of the systematic error of the published gyro bias, about x and y of the IMU.
  double gyro_bias_systematic_std_radps = 0.0013;
  /// Standard deviation of the systematic error of the published accelerometer bias.
  double accel_bias_systematic_std_mps2 = 0.12;
  /// Standard deviation of the accelerometer bias at power-on by the data sheet, for the published standard deviation.
  double accel_bias_sheet_std_mps2 = 0.2;
  /// Standard deviation of the error of the published accelerometer bias along the vertical, relative to gravity. The
  /// scale of the accelerometer has 0.005. The shocks of the gait shift the bias by 0.2 m/s2 in five minutes (seeds 11
  /// to 16).
  double accel_scale_std = 0.02;
  // Legs.
  double contact_on_force_n = 15.0;  ///< foot force above which a contact starts
  double contact_off_force_n = 8.0;  ///< foot force below which a contact ends
  /// Minimum foot force of a foot with its full weight in the filter; the weight is proportional to a smaller force.
  double full_weight_force_n = 30.0;
  double contact_settling_time_s = 0.012;  ///< time from the touch-down of a foot to its use in the filter
  double foot_velocity_std_mps = 0.06;     ///< standard deviation of the velocity of a stance foot
  /// Difference of a foot's velocity from the IMU prediction above which the foot is down-weighted.
  double slip_speed_mps = 0.15;
  /// Maximum height of a stance foot above the lowest foot, without foot sensors.
  double stance_height_tolerance_m = 0.012;
  // Standstill.
  double standstill_window_s = 1.0;     ///< duration of one measurement of the gyro bias at standstill
  double standstill_foot_std_m = 3e-5;  ///< standard deviation of a foot position at rest
  // Errors that are not white noise of a reading.
  double position_random_walk_m_per_sqrt_m = 0.01;  ///< random walk of the position over the distance traveled
  double yaw_random_walk_rad_per_sqrt_rad = 0.003;  ///< random walk of the yaw over the rotation
  // Faults.
  /// Maximum delay of the IMU behind the joint readings, after which the feet alone propagate the estimate.
  double imu_timeout_s = 0.1;
  double buffer_s = 2.0;              ///< length of the motion history, with which late readings are compared
  double max_extrapolation_s = 0.15;  ///< maximum time after the newest reading to which a pose is extrapolated

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_noise_density_radps_per_sqrt_hz", self.gyro_noise_density_radps_per_sqrt_hz, between(1e-7, 0.1));
    visit("gyro_bias_std_radps", self.gyro_bias_std_radps, between(0.0, 0.5));
    visit("gyro_bias_random_walk_radps_per_sqrt_s", self.gyro_bias_random_walk_radps_per_sqrt_s, between(0.0, 0.1));
    visit("accel_noise_density_mps2_per_sqrt_hz", self.accel_noise_density_mps2_per_sqrt_hz, between(1e-5, 10.0));
    visit("accel_bias_std_mps2", self.accel_bias_std_mps2, between(0.0, 5.0));
    visit("accel_bias_random_walk_mps2_per_sqrt_s", self.accel_bias_random_walk_mps2_per_sqrt_s, between(0.0, 1.0));
    visit("gyro_bias_systematic_std_radps", self.gyro_bias_systematic_std_radps, between(0.0, 0.5));
    visit("accel_bias_systematic_std_mps2", self.accel_bias_systematic_std_mps2, between(0.0, 5.0));
    visit("accel_bias_sheet_std_mps2", self.accel_bias_sheet_std_mps2, between(0.0, 5.0));
    visit("accel_scale_std", self.accel_scale_std, between(0.0, 0.5));
    visit("contact_on_force_n", self.contact_on_force_n, between(0.1, 200.0));
    visit("contact_off_force_n", self.contact_off_force_n, between(0.1, 200.0));
    visit("full_weight_force_n", self.full_weight_force_n, between(0.1, 1000.0));
    visit("contact_settling_time_s", self.contact_settling_time_s, between(0.0, 0.2));
    visit("foot_velocity_std_mps", self.foot_velocity_std_mps, between(1e-4, 1.0));
    visit("slip_speed_mps", self.slip_speed_mps, between(1e-3, 10.0));
    visit("stance_height_tolerance_m", self.stance_height_tolerance_m, between(0.0, 0.1));
    visit("standstill_window_s", self.standstill_window_s, between(0.1, 10.0));
    visit("standstill_foot_std_m", self.standstill_foot_std_m, between(1e-7, 0.01));
    visit("position_random_walk_m_per_sqrt_m", self.position_random_walk_m_per_sqrt_m, between(0.0, 0.5));
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 0.5));
    visit("imu_timeout_s", self.imu_timeout_s, between(0.01, 1.0));
    visit("buffer_s", self.buffer_s, between(0.5, 60.0));
    visit("max_extrapolation_s", self.max_extrapolation_s, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
