#pragma once

#include "core/settings.h"

namespace patrol::inspect {

/// How the antenna is set for soundings ahead of the face. A body's response is a quadratic form of the coil's axis: six numbers a gate,
/// which few directions would give; 35, as the paper's robot takes, spread as far as the mount turns, tell the form from steel and noise.
struct WaterSoundingSettings {
  int yaws = 7;
  double max_yaw_deg = 60.0;    ///< -60 ... 60 in steps of 20
  int pitches = 5;
  double max_pitch_deg = 30.0;  ///< -30 ... 30 in steps of 15
  double settled_deg = 0.5;     ///< the antenna is there when its servos read this close to what was asked, and no longer change
  double settle_s = 0.4;        ///< for so long
  double turn_timeout_s = 8.0;  ///< then the pose is left out
  double sounding_timeout_s = 5.0;
  int give_up_after = 3;        ///< poses left out in a row

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("yaws", self.yaws, between(1, 50));
    visit("max_yaw_deg", self.max_yaw_deg, between(0.0, 90.0));
    visit("pitches", self.pitches, between(1, 50));
    visit("max_pitch_deg", self.max_pitch_deg, between(0.0, 80.0));
    visit("settled_deg", self.settled_deg, between(0.05, 10.0));
    visit("settle_s", self.settle_s, between(0.0, 10.0));
    visit("turn_timeout_s", self.turn_timeout_s, between(0.1, 120.0));
    visit("sounding_timeout_s", self.sounding_timeout_s, between(0.1, 600.0));
    visit("give_up_after", self.give_up_after, between(1, 1000));
  }
};

/// What is known of the instrument (its data sheet) and how far it, the mount and the model are trusted; standard deviations.
struct SoundingErrorSettings {
  double ramp_s = 2.6e-6;             ///< the current's
  double gate_width = 0.15;           ///< of a gate, over its middle
  double model_std = 0.02;            ///< of a gate's rate, over it: what the model leaves out
  double gain_std = 0.03;             ///< the same in all soundings
  double sounding_gain_std = 0.01;    ///< from one to the next: the current, and the coil's angle
  double time_shift_std_s = 5e-8;     ///< of the gates, the same in all soundings
  double steel_rate = 1e-8;           ///< at 10 us of what steel near by may add, T/s per A m2
  double steel_anisotropy = 0.3;      ///< of its share that changes with the coil's direction

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ramp_s", self.ramp_s, between(1e-7, 1e-4));
    visit("gate_width", self.gate_width, between(0.01, 0.5));
    visit("model_std", self.model_std, between(1e-4, 1.0));
    visit("gain_std", self.gain_std, between(0.0, 1.0));
    visit("sounding_gain_std", self.sounding_gain_std, between(0.0, 1.0));
    visit("time_shift_std_s", self.time_shift_std_s, between(0.0, 1e-6));
    visit("steel_rate", self.steel_rate, at_least(0.0));
    visit("steel_anisotropy", self.steel_anisotropy, between(0.0, 10.0));
  }
};

/// What is believed of rock and water before the soundings, and what they are worth.
struct WaterPriorSettings {
  double min_rock_spm = 3e-4;       ///< conductivity, uniform in its logarithm between these
  double max_rock_spm = 0.03;
  double water_spm = 0.6;           ///< median of the conductivity of water or mud, as a probe in what seeps from the face reads it
  double water_log_std = 0.2;       ///< standard deviation of its logarithm
  double min_radius_m = 2.0;        ///< uniform in its logarithm between these
  double max_radius_m = 10.0;
  double max_distance_m = 40.0;     ///< to the body's middle, which is anywhere alike in the cone ahead: behind the robot it would do the same
  double max_angle_deg = 50.0;      ///< half angle of the cone about the body's x axis
  double min_clearance_m = 1.0;     ///< from the antenna to the body's nearest point

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
  int particles = 400;               ///< of the posterior
  int moves = 6;                     ///< Metropolis steps of each, at each temperature
  double min_evidence = 5.0;         ///< logarithm of the Bayes factor above which a body is reported: 150 to 1
  double alignment_std_deg = 0.4;    ///< of the antenna's axis on the robot, besides what its servos read
  double warning_distance_m = 30.0;  ///< a body whose nearest point may be this near is warned of
  double alarm_distance_m = 15.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sounding", self.sounding);
    visit("errors", self.errors);
    visit("prior", self.prior);
    visit("particles", self.particles, between(50, 20000));
    visit("moves", self.moves, between(1, 100));
    visit("min_evidence", self.min_evidence, between(0.0, 1000.0));
    visit("alignment_std_deg", self.alignment_std_deg, between(0.0, 10.0));
    visit("warning_distance_m", self.warning_distance_m, at_least(0.0));
    visit("alarm_distance_m", self.alarm_distance_m, at_least(0.0));
  }
};

}  // namespace patrol::inspect
