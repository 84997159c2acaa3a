#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct RangeLikelihoodSettings {
  /// Standard deviation of a LOS range; larger than that of the radio, because consecutive ranges have correlated
  /// errors.
  double range_std_m = 0.15;
  double nlos_probability = 0.1;      ///< likelihood of a marginal NLOS path relative to that of an exact range
  double nlos_bias_m = 0.5;           ///< mean NLOS bias
  double outlier_probability = 0.02;  ///< likelihood of any other range

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(0.005, 5.0));
    visit("nlos_probability", self.nlos_probability, between(0.0, 0.4));
    visit("nlos_bias_m", self.nlos_bias_m, between(0.01, 10.0));
    visit("outlier_probability", self.outlier_probability, between(1e-6, 0.4));
  }
};

}  // namespace patrol::localize
