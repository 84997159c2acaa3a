#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the tracked odometry. The defaults fit a MEMS IMU of robotics grade (biases at power-on: Analog Devices
/// ADIS16448 data sheet, table 1: 0.5 deg/s, 20 mg) and tracks on rock, gravel and concrete.
struct TrackOdometrySettings {
  // IMU.
  double gyro_noise_density_radps_per_sqrt_hz = 3.5e-4;  ///< noise density of readings sampled at 250 Hz, unfiltered
  double gyro_bias_std_radps = 8.7e-3;                   ///< standard deviation of the bias at power-on
  double gyro_bias_random_walk_radps_per_sqrt_s = 1e-5;  ///< random walk of the gyro bias
  /// Noise density of the accelerometer, with the vibration of driving.
  double accel_noise_density_mps2_per_sqrt_hz = 0.05;
  double accel_bias_std_mps2 = 0.2;                      ///< standard deviation of the bias at power-on
  double accel_bias_random_walk_mps2_per_sqrt_s = 1e-3;  ///< random walk of the accelerometer bias
  /// Random walk of the yaw over the rotation: gyro scale factor and misalignment.
  double yaw_random_walk_rad_per_sqrt_rad = 0.002;
  /// Standard deviation of the scale of the accelerometer, which the published bias along the vertical contains.
  double accel_scale_std = 0.005;
  // Track encoders and the standard deviation of the track speed, whose terms add in quadrature.
  double ticks_per_sprocket_turn = 720.0;  ///< edges of the Hall sensors of the motor, through the gear
  double skid_ratio = 1.5;           ///< track speed difference over the gauge, relative to the true yaw rate: scrub
  double speed_std_mps = 0.01;       ///< mean track speed during straight motion
  double scrub_std = 0.02;           ///< additional term per difference of the track speeds
  double acceleration_std_s = 0.01;  ///< additional term per acceleration of the tracks
  double disagreement_std_m = 0.05;  ///< additional term per disagreement of the yaw rates of tracks and gyro
  double lateral_std_mps = 0.02;     ///< lateral velocity, which is zero on average
  double lateral_std_m = 0.02;       ///< additional lateral term per yaw rate
  double vertical_std_mps = 0.05;    ///< vertical velocity, which is zero on average
  // Slip. The terms of its standard deviation add in quadrature.
  double scale_std = 0.01;                  ///< constant relative error of the track distance: wear, tension
  double slip_std = 0.015;                  ///< slip per distance, straight motion on level ground
  double slip_std_per_radps = 0.05;         ///< additional term per yaw rate
  double slip_std_per_tilt = 0.1;           ///< additional term per sine of the tilt, on slopes
  double slip_std_per_disagreement = 0.05;  ///< additional term per disagreement of the yaw rates, rad/s
  double slip_correlation_m = 3.0;          ///< correlation length of slip: distance over which the ground changes
  double icr_x_std_m = 0.05;                ///< longitudinal offset of the instantaneous center of rotation (ICR)
  double icr_y_std_m = 0.02;                ///< lateral offset of the ICR
  double icr_correlation_rad = 2.0;         ///< correlation angle of the ICR
  double slip_window_s = 1.0;               ///< window over which tracks and accelerometer are compared
  double slip_disagreement_mps = 0.2;       ///< speed gain of the tracks over the body that indicates loss of traction
  // Standstill.
  double settling_time_s = 1.5;      ///< time at rest before the first estimate
  double init_timeout_s = 6.0;       ///< time after which an estimate is published without any rest
  double standstill_window_s = 1.0;  ///< window of one gyro bias measurement, and of the detection of rest
  /// Standard deviation of the acceleration up to which the body is at rest: 0.05 m/s2 at rest, at least 0.16 m/s2
  /// while driving (simulated ADIS16448 on tracks).
  double standstill_accel_std_mps2 = 0.1;
  // Faults.
  double imu_timeout_s = 0.1;                 ///< maximum delay of the IMU behind the encoders before it is bridged
  double max_track_acceleration_mps2 = 10.0;  ///< largest acceleration of an accepted encoder reading
  double buffer_s = 2.0;                      ///< length of the motion history
  double max_extrapolation_s = 0.15;          ///< maximum time after the newest reading for which a pose is given

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_noise_density_radps_per_sqrt_hz", self.gyro_noise_density_radps_per_sqrt_hz, between(1e-7, 0.1));
    visit("gyro_bias_std_radps", self.gyro_bias_std_radps, between(0.0, 0.5));
    visit("gyro_bias_random_walk_radps_per_sqrt_s", self.gyro_bias_random_walk_radps_per_sqrt_s, between(0.0, 0.1));
    visit("accel_noise_density_mps2_per_sqrt_hz", self.accel_noise_density_mps2_per_sqrt_hz, between(1e-5, 10.0));
    visit("accel_bias_std_mps2", self.accel_bias_std_mps2, between(0.0, 5.0));
    visit("accel_bias_random_walk_mps2_per_sqrt_s", self.accel_bias_random_walk_mps2_per_sqrt_s, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 0.5));
    visit("accel_scale_std", self.accel_scale_std, between(0.0, 0.5));
    visit("ticks_per_sprocket_turn", self.ticks_per_sprocket_turn, between(1.0, 1e6));
    visit("skid_ratio", self.skid_ratio, between(1.0, 10.0));
    visit("speed_std_mps", self.speed_std_mps, between(1e-4, 1.0));
    visit("scrub_std", self.scrub_std, between(0.0, 1.0));
    visit("acceleration_std_s", self.acceleration_std_s, between(0.0, 1.0));
    visit("disagreement_std_m", self.disagreement_std_m, between(0.0, 1.0));
    visit("lateral_std_mps", self.lateral_std_mps, between(1e-4, 1.0));
    visit("lateral_std_m", self.lateral_std_m, between(0.0, 1.0));
    visit("vertical_std_mps", self.vertical_std_mps, between(1e-4, 1.0));
    visit("scale_std", self.scale_std, between(0.0, 0.5));
    visit("slip_std", self.slip_std, between(0.0, 0.5));
    visit("slip_std_per_radps", self.slip_std_per_radps, between(0.0, 1.0));
    visit("slip_std_per_tilt", self.slip_std_per_tilt, between(0.0, 2.0));
    visit("slip_std_per_disagreement", self.slip_std_per_disagreement, between(0.0, 1.0));
    visit("slip_correlation_m", self.slip_correlation_m, between(0.01, 1000.0));
    visit("icr_x_std_m", self.icr_x_std_m, between(0.0, 1.0));
    visit("icr_y_std_m", self.icr_y_std_m, between(0.0, 1.0));
    visit("icr_correlation_rad", self.icr_correlation_rad, between(0.01, 1000.0));
    visit("slip_window_s", self.slip_window_s, between(0.1, 5.0));
    visit("slip_disagreement_mps", self.slip_disagreement_mps, between(0.02, 10.0));
    visit("settling_time_s", self.settling_time_s, between(0.1, 60.0));
    visit("init_timeout_s", self.init_timeout_s, between(0.1, 600.0));
    visit("standstill_window_s", self.standstill_window_s, between(0.1, 10.0));
    visit("standstill_accel_std_mps2", self.standstill_accel_std_mps2, between(0.0, 10.0));
    visit("imu_timeout_s", self.imu_timeout_s, between(0.01, 1.0));
    visit("max_track_acceleration_mps2", self.max_track_acceleration_mps2, between(0.5, 1000.0));
    visit("buffer_s", self.buffer_s, between(0.5, 60.0));
    visit("max_extrapolation_s", self.max_extrapolation_s, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
