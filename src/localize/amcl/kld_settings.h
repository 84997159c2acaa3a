#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of KLD sampling, which adapts the number of particles to their spread (kld.h).
struct KldSettings {
  double bin_m = 0.5;       ///< size of a bin of the particle histogram in x and y
  double bin_rad = 0.1745;  ///< size of a bin of the particle histogram in yaw; 0.1745: 10 degrees
  /// Maximum Kullback-Leibler divergence between particles and posterior, epsilon in [Fox03].
  double max_kl_divergence = 0.05;
  /// Upper quantile of the standard normal distribution for the probability of keeping max_kl_divergence, z in [Fox03];
  /// 2.326: probability of 0.99.
  double normal_quantile = 2.326;
  int min_particles = 300;   ///< minimum number of particles
  int max_particles = 5000;  ///< maximum number of particles

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("bin_m", self.bin_m, between(0.01, 10.0));
    visit("bin_rad", self.bin_rad, between(0.01, 3.2));
    visit("max_kl_divergence", self.max_kl_divergence, between(1e-4, 1.0));
    visit("normal_quantile", self.normal_quantile, between(0.0, 6.0));
    visit("min_particles", self.min_particles, between(1, 1000000));
    visit("max_particles", self.max_particles, between(1, 1000000));
  }
};

}  // namespace patrol::localize
