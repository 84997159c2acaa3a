#pragma once

#include <vector>

#include "core/settings.h"
#include "core/uwb.h"

namespace patrol::localize {

/// Settings of the estimation of the range delays of UWB anchors.
struct AnchorDelayEstimatorSettings {
  double prior_delay_std_m = 0.15;  ///< prior standard deviation of the range delay of an anchor
  double prior_map_std_m = 0.05;    ///< prior standard deviation of the origin of map in the survey: put-down error
  double prior_map_std_rad = 0.01;  ///< prior standard deviation of the yaw of map in the survey: put-down error
  double range_std_m = 0.1;         ///< nominal standard deviation of a range in line of sight
  /// Standard deviation of the error of a delay by non-line-of-sight (NLOS) ranges that are not rejected.
  double bias_std_m = 0.03;
  double outlier_sigma = 2.5;  ///< maximum residual of an accepted range, in standard deviations

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("prior_delay_std_m", self.prior_delay_std_m, between(1e-4, 100.0));
    visit("prior_map_std_m", self.prior_map_std_m, between(1e-6, 100.0));
    visit("prior_map_std_rad", self.prior_map_std_rad, between(1e-6, 3.0));
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("bias_std_m", self.bias_std_m, between(0.0, 10.0));
    visit("outlier_sigma", self.outlier_sigma, between(1.0, 100.0));
  }
};

}  // namespace patrol::localize
