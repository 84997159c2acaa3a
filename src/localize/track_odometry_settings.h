#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the odometry of a robot on tracks or on wheels. The defaults fit a MEMS IMU of robotics grade (biases at
/// power-on: Analog Devices ADIS16448 data sheet, table 1: 0.5 deg/s, 20 mg) and tracks on rock, gravel and concrete.
struct TrackOdometrySettings {
  // IMU.
  /// Noise density of the gyro; readings sampled at 250 Hz, unfiltered.
  double gyro_noise_density_radps_per_sqrt_hz = 3.5e-4;
  double gyro_bias_std_radps = 8.7e-3;                   ///< prior standard deviation of the gyro bias at power-on
  double gyro_bias_random_walk_radps_per_sqrt_s = 1e-5;  ///< random walk of the gyro bias
  /// Noise density of the accelerometer, with the vibration of driving.
  double accel_noise_density_mps2_per_sqrt_hz = 0.05;
  double accel_bias_std_mps2 = 0.2;  ///< prior standard deviation of the accelerometer bias at power-on
  double accel_bias_random_walk_mps2_per_sqrt_s = 1e-3;  ///< random walk of the accelerometer bias
  /// Random walk of the yaw over the rotation: gyro scale factor and misalignment.
  double yaw_random_walk_rad_per_sqrt_rad = 0.002;
  /// Standard deviation of the scale of the accelerometer, which the published bias along the vertical contains.
  double accel_scale_std = 0.005;
  // Track encoders and the standard deviation of the track speed, whose terms add in quadrature.
  /// Number of counts per turn of the sprocket or wheel: Hall sensor edges of the motor through the gear, or counts of
  /// the wheel encoder.
  double ticks_per_sprocket_turn = 720.0;
  /// Ratio of the track speed difference over the gauge to the true yaw rate: scrub. 0 is the closed form of Coulomb
  /// friction for the geometry of the robot.
  double skid_ratio = 1.5;
  double speed_std_mps = 0.01;  ///< standard deviation of the mean track speed during straight motion
  /// Term of the standard deviation of the mean track speed per difference of the track speeds, added in quadrature.
  double scrub_std = 0.02;
  /// Term of the standard deviation of the mean track speed per acceleration of the tracks, added in quadrature.
  double acceleration_std_s = 0.01;
  /// Term of the standard deviation of the mean track speed per disagreement of the yaw rates of tracks and gyro, added
  /// in quadrature.
  double disagreement_std_m = 0.05;
  /// Standard deviation of the lateral velocity of the instantaneous center of rotation, which is zero on average.
  double lateral_std_mps = 0.02;
  /// Term of the standard deviation of the lateral velocity per yaw rate, added in quadrature.
  double lateral_std_m = 0.02;
  double vertical_std_mps = 0.05;  ///< standard deviation of the vertical velocity, which is zero on average
  // Slip. The terms of its standard deviation add in quadrature.
  double scale_std = 0.01;  ///< standard deviation of the constant relative error of the track distance: wear, tension
  double slip_std = 0.015;  ///< standard deviation of the slip ratio during straight motion on level ground
  /// Standard deviation of the velocity across the direction of motion relative to the speed, for mecanum wheels, whose
  /// unequal radii move the robot sideways. Other drives move along the direction of their wheels.
  double cross_slip_std = 0.01;
  /// Term of the standard deviation of the slip ratio per yaw rate, added in quadrature.
  double slip_std_per_radps = 0.05;
  /// Term of the standard deviation of the slip ratio per sine of the tilt, on slopes, added in quadrature.
  double slip_std_per_tilt = 0.1;
  /// Term of the standard deviation of the slip ratio per disagreement of the yaw rates of tracks and gyro, in rad/s,
  /// added in quadrature.
  double slip_std_per_disagreement = 0.05;
  double slip_correlation_m = 3.0;  ///< correlation length of slip: distance over which the ground changes
  /// Standard deviation of the longitudinal offset of the instantaneous center of rotation: lateral slip during
  /// rotation.
  double icr_x_std_m = 0.05;
  /// Standard deviation of the lateral offset of the instantaneous center of rotation: different traction of the two
  /// sides.
  double icr_y_std_m = 0.02;
  double icr_correlation_rad = 2.0;  ///< correlation angle of the offset of the instantaneous center of rotation
  double slip_window_s = 1.0;        ///< duration over which the speed changes of tracks and accelerometer are compared
  /// Minimum difference of the speed changes of tracks and body that indicates a loss of traction; increased on a rough
  /// ride.
  double slip_disagreement_mps = 0.2;
  // Standstill.
  double settling_time_s = 1.5;  ///< minimum time at rest before the first estimate
  /// Maximum time before the first estimate, which is then published without a standstill.
  double init_timeout_s = 6.0;
  /// Duration of one measurement of the gyro bias at standstill and of the detection of rest.
  double standstill_window_s = 1.0;
  /// Maximum standard deviation of the acceleration of a body at rest, along each axis. Simulated ADIS16448 on tracks:
  /// 0.05 m/s2 at rest, at least 0.16 m/s2 while driving.
  double standstill_accel_std_mps2 = 0.1;
  // Faults.
  /// Maximum delay of the IMU behind the encoders, after which the tracks alone propagate the estimate.
  double imu_timeout_s = 0.1;
  /// Maximum track acceleration of an accepted encoder reading; larger ones are accepted only if they persist.
  double max_track_acceleration_mps2 = 10.0;
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
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 0.5));
    visit("accel_scale_std", self.accel_scale_std, between(0.0, 0.5));
    visit("ticks_per_sprocket_turn", self.ticks_per_sprocket_turn, between(1.0, 1e6));
    visit("skid_ratio", self.skid_ratio, between(0.0, 10.0));
    visit("speed_std_mps", self.speed_std_mps, between(1e-4, 1.0));
    visit("scrub_std", self.scrub_std, between(0.0, 1.0));
    visit("acceleration_std_s", self.acceleration_std_s, between(0.0, 1.0));
    visit("disagreement_std_m", self.disagreement_std_m, between(0.0, 1.0));
    visit("lateral_std_mps", self.lateral_std_mps, between(1e-4, 1.0));
    visit("lateral_std_m", self.lateral_std_m, between(0.0, 1.0));
    visit("vertical_std_mps", self.vertical_std_mps, between(1e-4, 1.0));
    visit("scale_std", self.scale_std, between(0.0, 0.5));
    visit("slip_std", self.slip_std, between(0.0, 0.5));
    visit("cross_slip_std", self.cross_slip_std, between(0.0, 0.5));
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
