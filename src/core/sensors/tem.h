#pragma once

#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// A transient-electromagnetic sounding, stacked: after the current in the coil is switched off, the rate of change of the magnetic
/// field along the coil's axis.
struct TemSounding {
  Time stamp{};                    ///< of its end
  double moment_am2 = 0.0;         ///< of the transmitter
  std::vector<double> gate_s;      ///< [gate]: middle, after the end of the current's ramp
  std::vector<double> rate_tps;    ///< [gate]: -dB/dt, T/s
  std::vector<double> std_tps;     ///< [gate]: of the mean over the stack, as the instrument estimates it
};

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

template <>
struct SensorTraits<TemSounding> {
  struct Settings {
    TemSettings tem;
  };
  static constexpr auto kSettings = &Settings::tem;
  static constexpr SensorInfo kInfo = {.name = "tem",
                                      .topic = "/tem/sounding",
                                      .ros_type = "patrol_msgs/msg/TemSounding",
                                      .summary = "transient-electromagnetic water detector, on command",
                                      .not_in_fault_matrix = "used only to sound for water, beyond the fault window of the matrix"};

  static void add_to_reading(TemSounding& sounding, double offset_tps) {
    for (double& rate_tps : sounding.rate_tps) rate_tps += offset_tps;
  }
};

}  // namespace patrol
