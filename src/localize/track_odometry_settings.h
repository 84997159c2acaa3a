#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Defaults fit a MEMS IMU of robotics grade and tracks on rock, gravel and concrete.
struct TrackOdometrySettings {
  // IMU.
  double gyro_noise_density_radps_per_sqrt_hz = 3.5e-4;  ///< of readings taken at 250 Hz, not averaged in between
  double gyro_bias_std_radps = 5e-3;             ///< at switch-on
  double gyro_bias_random_walk_radps_per_sqrt_s = 1e-5;
  double accel_noise_density_mps2_per_sqrt_hz = 0.05;  ///< the shocks of driving included
  double accel_bias_std_mps2 = 0.05;           ///< at switch-on
  double accel_bias_random_walk_mps2_per_sqrt_s = 1e-3;
  double yaw_random_walk_rad_per_sqrt_rad = 0.002;  ///< the gyro's scale and misalignment
  // What the counters are, and how far the belts are to be believed.
  double ticks_per_sprocket_turn = 720.0;  ///< edges of the motor's Hall sensors, by the gear
  double skid_ratio = 1.5;             ///< yaw rate by the belts' difference over the gauge, to the true one: scrub
  double speed_std_mps = 0.01;         ///< of the mean belt speed, straight on
  double scrub_std = 0.02;             ///< and more by this share of the belts' difference,
  double acceleration_std_s = 0.01;    ///< by this time of their acceleration,
  double disagreement_std_m = 0.05;    ///< and by this length of what their yaw rate and the gyro's differ
  double lateral_std_mps = 0.02;       ///< nothing goes sideways,
  double lateral_std_m = 0.02;         ///< except on turns: by this length of the yaw rate
  double vertical_std_mps = 0.05;
  // Slip.
  double scale_std = 0.01;                   ///< of the belts' way: wear, tension; constant
  double slip_std = 0.015;                   ///< share of the way, straight on in the plane
  double slip_std_per_radps = 0.05;          ///< more on turns,
  double slip_std_per_tilt = 0.1;            ///< on slopes, by the sine of the tilt,
  double slip_std_per_disagreement = 0.05;   ///< and when belts and gyro differ on the yaw rate, by rad/s
  double slip_correlation_m = 3.0;                ///< over which the ground changes
  double icr_x_std_m = 0.05;
  double icr_y_std_m = 0.02;
  double icr_correlation_rad = 2.0;
  double slip_window_s = 1.0;                ///< belts and accelerometer are compared over
  double slip_disagreement_mps = 0.2;        ///< belts that gain so much more than the body have lost their grip
  // Standing.
  double settling_time_s = 1.5;        ///< at rest, before the first estimate
  double init_timeout_s = 6.0;  ///< then an estimate is given without any rest
  double standstill_window_s = 1.0;
  // Faults.
  double imu_timeout_s = 0.1;   ///< how long the belts wait for a late IMU before the odometry goes on without
  double max_track_acceleration_mps2 = 10.0;  ///< beyond, the counters are not believed
  double buffer_s = 2.0;
  double max_extrapolation_s = 0.15;  ///< beyond the newest reading

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gyro_noise_density_radps_per_sqrt_hz", self.gyro_noise_density_radps_per_sqrt_hz, between(1e-7, 0.1));
    visit("gyro_bias_std_radps", self.gyro_bias_std_radps, between(0.0, 0.5));
    visit("gyro_bias_random_walk_radps_per_sqrt_s", self.gyro_bias_random_walk_radps_per_sqrt_s, between(0.0, 0.1));
    visit("accel_noise_density_mps2_per_sqrt_hz", self.accel_noise_density_mps2_per_sqrt_hz, between(1e-5, 10.0));
    visit("accel_bias_std_mps2", self.accel_bias_std_mps2, between(0.0, 5.0));
    visit("accel_bias_random_walk_mps2_per_sqrt_s", self.accel_bias_random_walk_mps2_per_sqrt_s, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_rad", self.yaw_random_walk_rad_per_sqrt_rad, between(0.0, 0.5));
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
    visit("imu_timeout_s", self.imu_timeout_s, between(0.01, 1.0));
    visit("max_track_acceleration_mps2", self.max_track_acceleration_mps2, between(0.5, 1000.0));
    visit("buffer_s", self.buffer_s, between(0.5, 60.0));
    visit("max_extrapolation_s", self.max_extrapolation_s, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
