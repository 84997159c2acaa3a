#pragma once

#include "core/settings.h"

namespace patrol::inspect {

/// Antenna orientations for soundings ahead of the face. The response of a body is a quadratic form of the coil axis:
/// six numbers per gate. The 35 orientations of [Liu21], spread over the range of the mount, separate that form from
/// steel and noise.
struct WaterSoundingSettings {
  int yaws = 7;                        ///< number of antenna yaws
  double max_yaw_deg = 60.0;           ///< largest antenna yaw to both sides
  int pitches = 5;                     ///< number of antenna pitches
  double max_pitch_deg = 30.0;         ///< largest antenna pitch, up and down
  double settled_tolerance_deg = 0.5;  ///< maximum angle error of a settled antenna, which must also have stopped
  double settling_time_s = 0.4;        ///< minimum duration of the settled state
  double orientation_timeout_s = 8.0;  ///< time after which an antenna pose is skipped
  double sounding_timeout_s = 5.0;     ///< maximum time of waiting for a sounding
  int max_consecutive_failures = 3;    ///< maximum number of consecutively skipped poses

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("yaws", self.yaws, between(1, 50));
    visit("max_yaw_deg", self.max_yaw_deg, between(0.0, 90.0));
    visit("pitches", self.pitches, between(1, 50));
    visit("max_pitch_deg", self.max_pitch_deg, between(0.0, 80.0));
    visit("settled_tolerance_deg", self.settled_tolerance_deg, between(0.05, 10.0));
    visit("settling_time_s", self.settling_time_s, between(0.0, 10.0));
    visit("orientation_timeout_s", self.orientation_timeout_s, between(0.1, 120.0));
    visit("sounding_timeout_s", self.sounding_timeout_s, between(0.1, 600.0));
    visit("max_consecutive_failures", self.max_consecutive_failures, between(1, 1000));
  }
};

/// Instrument parameters (data sheet) and standard deviations of the errors of instrument, mount and model.
struct SoundingErrorSettings {
  double ramp_s = 2.6e-6;           ///< ramp time of the current
  double gate_width = 0.15;         ///< ratio of gate width to gate center
  double model_std = 0.02;          ///< relative model error of a gate
  double gain_std = 0.03;           ///< relative gain error common to all soundings
  double sounding_gain_std = 0.01;  ///< relative gain error of each sounding: current and coil angle
  double time_shift_std_s = 5e-8;   ///< time shift of the gates, common to all soundings
  double steel_response = 1e-8;     ///< response of nearby steel at 10 us, T/s per A m2
  double steel_anisotropy = 0.3;    ///< anisotropic part of the steel response, relative to `steel_response`
  /// Relative response of the tunnel's air across its axis, at 2 us in rock of 0.003 S/m; 0.3 of it along the axis. A
  /// tunnel of 5.5 m radius: -0.23 far from the face, half of it at the face (sim/tem/tunnel_air.h). With 0, 7 of 10
  /// faces without water are reported as water.
  double tunnel_air_std = 0.2;
  /// Relative early response of layers and fault zones in rock of 0.003 S/m, isotropic and anisotropic. A zone of 0.01
  /// S, 9 m away: 0.2. With 0, a wet fault zone from 0.007 S on is reported as a body of water. With 0.02, it is not,
  /// but neither are 4 of 20 water bodies: small bodies and zones decay alike.
  double layer_std = 0.0;
  /// Relative deviation of the response of a body from that of a sphere, along and across the line of sight. Spheroids
  /// of aspect ratios 1/2 to 2 and the same volume have 0.63 to 1.59 times the moment of the sphere.
  double body_shape_std = 0.25;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ramp_s", self.ramp_s, between(1e-7, 1e-4));
    visit("gate_width", self.gate_width, between(0.01, 0.5));
    visit("model_std", self.model_std, between(1e-4, 1.0));
    visit("gain_std", self.gain_std, between(0.0, 1.0));
    visit("sounding_gain_std", self.sounding_gain_std, between(0.0, 1.0));
    visit("time_shift_std_s", self.time_shift_std_s, between(0.0, 1e-6));
    visit("steel_response", self.steel_response, at_least(0.0));
    visit("steel_anisotropy", self.steel_anisotropy, between(0.0, 10.0));
    visit("tunnel_air_std", self.tunnel_air_std, between(0.0, 1.0));
    visit("layer_std", self.layer_std, between(0.0, 1.0));
    visit("body_shape_std", self.body_shape_std, between(0.0, 1.0));
  }
};

/// Prior of rock and water.
struct WaterPriorSettings {
  double min_rock_spm = 3e-4;  ///< lower limit of the rock conductivity, uniform in its logarithm
  double max_rock_spm = 0.03;  ///< upper limit of the rock conductivity
  double water_spm = 0.6;  ///< median conductivity of water or mud, as measured by a probe in the seepage of the face
  /// Standard deviation of the logarithm of the conductivity: mud and mineralized water have 0.3 to 1 S/m.
  double water_log_std = 0.35;
  double min_radius_m = 2.0;   ///< lower limit of the radius, uniform in its logarithm
  double max_radius_m = 10.0;  ///< upper limit of the radius
  /// Maximum distance to the center of the body, which is uniform in a cone ahead; behind the robot it would be
  /// indistinguishable.
  double max_distance_m = 40.0;
  double max_angle_deg = 50.0;   ///< half angle of the cone around the x axis of the robot
  double min_clearance_m = 1.0;  ///< minimum distance from the antenna to the nearest point of the body

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_rock_spm", self.min_rock_spm, between(1e-5, 1.0));
    visit("max_rock_spm", self.max_rock_spm, between(1e-5, 1.0));
    visit("water_spm", self.water_spm, between(0.01, 10.0));
    visit("water_log_std", self.water_log_std, between(0.001, 2.0));
    visit("min_radius_m", self.min_radius_m, between(0.1, 50.0));
    visit("max_radius_m", self.max_radius_m, between(0.1, 50.0));
    visit("max_distance_m", self.max_distance_m, between(2.0, 200.0));
    visit("max_angle_deg", self.max_angle_deg, between(1.0, 90.0));
    visit("min_clearance_m", self.min_clearance_m, between(0.2, 50.0));
  }
};

struct WaterSettings {
  WaterSoundingSettings sounding;
  SoundingErrorSettings errors;
  WaterPriorSettings prior;
  int particles = 400;        ///< number of posterior particles
  int mcmc_steps = 6;         ///< Metropolis steps per particle and temperature
  double min_evidence = 5.0;  ///< minimum logarithm of the Bayes factor for a detection: 150 to 1
  /// Standard deviation of the antenna axis on the robot, in addition to the encoder errors.
  double alignment_std_deg = 0.4;
  /// Distance of the near limit of a body's nearest point within which the body is a warning.
  double warning_distance_m = 30.0;
  /// Distance of the near limit of a body's nearest point within which the body is an alarm.
  double alarm_distance_m = 15.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sounding", self.sounding);
    visit("errors", self.errors);
    visit("prior", self.prior);
    visit("particles", self.particles, between(50, 20000));
    visit("mcmc_steps", self.mcmc_steps, between(1, 100));
    visit("min_evidence", self.min_evidence, between(0.0, 1000.0));
    visit("alignment_std_deg", self.alignment_std_deg, between(0.0, 10.0));
    visit("warning_distance_m", self.warning_distance_m, at_least(0.0));
    visit("alarm_distance_m", self.alarm_distance_m, at_least(0.0));
  }
};

}  // namespace patrol::inspect
