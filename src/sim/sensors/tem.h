#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "core/tem_response.h"
#include "sim/water_ahead.h"

namespace patrol::sim {

/// A transient-electromagnetic instrument on a coil of the robot's size: six turns of 0.3 m in radius, 20 A. Ramp, gates and noise after tTEM
/// (Auken et al., "tTEM - A towed transient electromagnetic system for detailed 3D imaging of the top 70 m of the subsurface", Geophysics 84(1),
/// 2019): 22 A m2 switched off in 2.6 us, first gate 1.4 us after that, noise in the gates falling as t^(-1/2) from nV/m2 at 1 ms, a uniform
/// standard deviation of 3 % besides, which is split here into what stays the same (gain, time shift) and what changes. The rest are assumptions.
struct TemSettings {
  bool enabled = false;
  double moment_am2 = 34.0;            ///< turns x area x current
  double ramp_s = 2.6e-6;              ///< the current's, straight down to nothing
  double first_gate_s = 2.0e-6;        ///< its middle, after the end of the ramp
  double last_gate_s = 3.0e-4;         ///< no gate lies later
  double gates_per_decade = 10.0;
  double gate_width = 0.15;            ///< of a gate, over its middle
  double stacking_s = 1.0;             ///< of one sounding
  double noise_tps = 3e-9;             ///< standard deviation at 1 ms, of the mean over a second's stack
  double relative_noise = 0.01;        ///< standard deviation of a gate of a sounding
  double gain_std = 0.02;              ///< of the instrument, the same in all soundings
  double current_std = 0.003;          ///< of the moment that is reported, from sounding to sounding
  double time_shift_std_s = 3e-8;      ///< of the gates, the same in all soundings
  double steel_rate = 5e-9;            ///< median at 10 us of what steel arches, reinforcement and the robot add, T/s per A m2
  double steel_spread = 0.5;           ///< standard deviation of its logarithm, from run to run
  double steel_anisotropy = 0.2;       ///< of its share that changes with the coil's direction
  double latency_s = 0.05;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("moment_am2", self.moment_am2, between(0.1, 10000.0));
    visit("ramp_s", self.ramp_s, between(1e-7, 1e-4));
    visit("first_gate_s", self.first_gate_s, between(5e-7, 1e-3));
    visit("last_gate_s", self.last_gate_s, between(1e-6, 1e-2));
    visit("gates_per_decade", self.gates_per_decade, between(3.0, 30.0));
    visit("gate_width", self.gate_width, between(0.01, 0.5));
    visit("stacking_s", self.stacking_s, between(0.02, 60.0));
    visit("noise_tps", self.noise_tps, at_least(0.0));
    visit("relative_noise", self.relative_noise, between(0.0, 1.0));
    visit("gain_std", self.gain_std, between(0.0, 0.3));
    visit("current_std", self.current_std, between(0.0, 0.3));
    visit("time_shift_std_s", self.time_shift_std_s, between(0.0, 1e-6));
    visit("steel_rate", self.steel_rate, at_least(0.0));
    visit("steel_spread", self.steel_spread, between(0.0, 2.0));
    visit("steel_anisotropy", self.steel_anisotropy, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

/// The coil among rock and water. Bodies add up: that one screens another is left out. Steel is a sum of three exponential decays
/// (15, 60, 250 us), near t^-1 in between, that changes with the coil's direction as a quadratic form of its axis; drawn for the run.
///
/// Not modelled: the tunnel's air, the receiver's low-pass (the instrument takes its delay out; what is left is the time shift), polarisation of
/// the rock, mains and radio.
class Tem {
 public:
  /// Throws InputError for gates that are none.
  Tem(const TemSettings& settings, const RockSettings& rock, const std::vector<WaterBodySettings>& bodies, std::uint64_t seed);

  /// Begins a sounding, unless one is under way.
  void start(Time now);
  bool is_sounding() const { return start_.has_value(); }

  /// Once a tick, with the coil's true pose (its axis is x). Gives the sounding at its end.
  std::optional<TemSounding> step(const Pose3& T_world_tem, Time now);

  /// Sounding number `count`, of a coil at `p_world` whose axis a has the mean outer product `axes` = <a a^T> over the stack.
  TemSounding sound(const Eigen::Vector3d& p_world, const Eigen::Matrix3d& axes, std::uint64_t count, Time end) const;

 private:
  TemSettings settings_;
  RockSettings rock_;
  std::vector<WaterBodySettings> bodies_;
  TemWindow window_;  ///< as reported
  TemGates gates_;    ///< as they really are, shifted
  double gain_ = 1.0, steel_rate_ = 0.0;
  Eigen::Matrix3d steel_form_ = Eigen::Matrix3d::Zero();
  RandomStream noise_, relative_noise_, current_;
  std::optional<Time> start_;
  std::uint64_t count_ = 0;
  int ticks_ = 0;
  Eigen::Vector3d sum_p_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d sum_axes_ = Eigen::Matrix3d::Zero();
};

}  // namespace patrol::sim
