#pragma once

#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Stacked transient-electromagnetic sounding: rate of change of the magnetic field along the coil's axis after the
/// current in the coil is switched off.
struct TemSounding {
  Time stamp{};                  ///< end of the sounding
  double moment_am2 = 0.0;       ///< magnetic moment of the transmitter
  std::vector<double> gate_s;    ///< [gate], center of the gate after the end of the current ramp
  std::vector<double> rate_tps;  ///< [gate], -dB/dt, T/s
  std::vector<double> std_tps;   ///< [gate], standard deviation of the stack mean, as estimated by the instrument
};

/// Transient-electromagnetic instrument with a coil that fits the robot: six turns of 0.3 m radius, 20 A. Ramp, gates
/// and noise after tTEM [Auken19]: 22 A m2 switched off in 2.6 us, first gate 1.4 us later. Gate noise decays as
/// t^(-1/2) from nV/m2 at 1 ms, plus a uniform standard deviation of 3 %. The 3 % are split here into a constant part
/// (gain, time shift) and a varying part. All other values are assumptions.
struct TemSettings {
  bool enabled = false;                ///< presence of the sensor; false: no messages
  double moment_am2 = 34.0;            ///< magnetic moment: turns x area x current
  double ramp_s = 2.6e-6;              ///< duration of the linear turn-off ramp of the current
  double first_gate_s = 2.0e-6;        ///< center of the first gate after the end of the ramp
  double last_gate_s = 3.0e-4;         ///< upper limit of the gate centers
  double gates_per_decade = 10.0;      ///< number of time gates per decade of time
  double relative_gate_width = 0.15;   ///< width of a gate relative to its center time
  double stacking_s = 1.0;             ///< stacking time of one sounding
  double noise_std_tps = 3e-9;         ///< standard deviation at 1 ms of the mean over one second of stacking
  double relative_noise_std = 0.01;    ///< relative standard deviation of each gate of a sounding
  double gain_std = 0.02;              ///< standard deviation of the instrument gain, constant over all soundings
  double relative_moment_std = 0.003;  ///< standard deviation of the moment, relative to the reported one, per sounding
  double time_shift_std_s = 3e-8;      ///< standard deviation of the gate time shift, constant over all soundings
  double steel_response = 5e-9;        ///< median response at 10 us of steel arches, reinforcement and robot, T/s per A
                                       ///< m2
  double steel_log_std = 0.5;          ///< standard deviation of the logarithm of `steel_response`, over runs
  double steel_anisotropy_std = 0.2;   ///< standard deviation of the direction-dependent fraction of the steel response
  double latency_s = 0.05;             ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("moment_am2", self.moment_am2, between(0.1, 10000.0));
    visit("ramp_s", self.ramp_s, between(1e-7, 1e-4));
    visit("first_gate_s", self.first_gate_s, between(5e-7, 1e-3));
    visit("last_gate_s", self.last_gate_s, between(1e-6, 1e-2));
    visit("gates_per_decade", self.gates_per_decade, between(3.0, 30.0));
    visit("relative_gate_width", self.relative_gate_width, between(0.01, 0.5));
    visit("stacking_s", self.stacking_s, between(0.02, 60.0));
    visit("noise_std_tps", self.noise_std_tps, at_least(0.0));
    visit("relative_noise_std", self.relative_noise_std, between(0.0, 1.0));
    visit("gain_std", self.gain_std, between(0.0, 0.3));
    visit("relative_moment_std", self.relative_moment_std, between(0.0, 0.3));
    visit("time_shift_std_s", self.time_shift_std_s, between(0.0, 1e-6));
    visit("steel_response", self.steel_response, at_least(0.0));
    visit("steel_log_std", self.steel_log_std, between(0.0, 2.0));
    visit("steel_anisotropy_std", self.steel_anisotropy_std, between(0.0, 1.0));
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
                                       .frame = "tem_mount",
                                       .fault_matrix_exclusion_reason =
                                           "used only for TEM soundings, outside the fault window of the matrix"};

  static void add_to_reading(TemSounding& sounding, double offset_tps) {
    for (double& rate_tps : sounding.rate_tps) rate_tps += offset_tps;
  }
};

}  // namespace patrol
