#pragma once

#include "core/settings.h"
#include "core/uwb.h"

namespace patrol::slam {

struct RangeUpdateSettings {
  bool enabled = true;
  double range_std_m = 0.15;        ///< standard deviation of a LOS range: radio noise and residual calibration bias
  double gate_sigma = 3.0;          ///< ranges shorter than predicted by more standard deviations are rejected
  double nlos_gate_sigma = 2.0;     ///< ranges longer than predicted by more standard deviations are rejected as NLOS
  UwbCalibration calibration = {};  ///< bias calibration of the radio; not a scenario setting

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("range_std_m", self.range_std_m, between(0.001, 10.0));
    visit("gate_sigma", self.gate_sigma, between(0.5, 100.0));
    visit("nlos_gate_sigma", self.nlos_gate_sigma, between(0.5, 100.0));
  }
};

}  // namespace patrol::slam
