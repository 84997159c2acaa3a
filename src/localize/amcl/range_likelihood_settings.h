#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the likelihood of a UWB range for a particle (range_likelihood.h).
struct RangeLikelihoodSettings {
  /// Standard deviation of a line-of-sight (LOS) range; larger than that of the radio, because consecutive ranges have
  /// correlated errors.
  double range_std_m = 0.15;
  /// Likelihood of a non-line-of-sight (NLOS) range with a small bias, relative to an exact range.
  double nlos_probability = 0.1;
  double nlos_bias_m = 0.5;  ///< mean bias of non-line-of-sight (NLOS) ranges
  /// Likelihood of an outlier relative to an exact range: lower bound of the range likelihood.
  double outlier_probability = 0.02;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(0.005, 5.0));
    visit("nlos_probability", self.nlos_probability, between(0.0, 0.4));
    visit("nlos_bias_m", self.nlos_bias_m, between(0.01, 10.0));
    visit("outlier_probability", self.outlier_probability, between(1e-6, 0.4));
  }
};

}  // namespace patrol::localize
