#pragma once

#include "core/settings.h"
#include "core/uwb.h"

namespace patrol::slam {

struct RangeUpdateSettings {
  bool enabled = true;        ///< use of UWB ranges in SLAM
  double range_std_m = 0.15;  ///< standard deviation of a LOS range: radio noise and residual calibration bias
  /// Standard deviation of the error that the ranges to an anchor near one place have in common: reflections, antenna
  /// patterns. Used by range factors.
  double common_std_m = 0.05;
  /// Scale of the Cauchy kernel of range factors, standard deviations: NLOS ranges are 0.2 to 0.4 m too long for
  /// meters.
  double outlier_scale_sigma = 1.0;
  double anchor_delay_std_m = 0.1;  ///< standard deviation of the constant error of the ranges to an anchor
  /// Number of standard deviations beyond which a range that is shorter than predicted is rejected.
  double gate_sigma = 3.0;
  /// Number of standard deviations beyond which a range that is longer than predicted is rejected as NLOS.
  double nlos_gate_sigma = 2.0;
  UwbCalibration calibration = {};  ///< bias of the radio; in a stack that of `uwb_filter`

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("range_std_m", self.range_std_m, between(0.001, 10.0));
    visit("common_std_m", self.common_std_m, between(0.0, 10.0));
    visit("outlier_scale_sigma", self.outlier_scale_sigma, between(0.1, 1e3));
    visit("anchor_delay_std_m", self.anchor_delay_std_m, between(1e-6, 10.0));
    visit("gate_sigma", self.gate_sigma, between(0.5, 100.0));
    visit("nlos_gate_sigma", self.nlos_gate_sigma, between(0.5, 100.0));
  }
};

}  // namespace patrol::slam
