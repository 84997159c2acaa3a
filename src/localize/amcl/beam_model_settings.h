#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the beam model of a scan (beam_model.h). The mixture weights are normalized by their sum.
struct BeamModelSettings {
  double z_hit = 0.75;     ///< mixture weight of a return from the surface of the map
  double z_short = 0.1;    ///< mixture weight of a return from an unmapped obstacle in front of the surface
  double z_max = 0.1;      ///< mixture weight of a beam without return
  double z_rand = 0.05;    ///< mixture weight of a random return
  double hit_std_m = 0.1;  ///< standard deviation of the range of a return from the surface of the map
  /// Mean of the exponential distribution of the ranges to unmapped obstacles: 1 / lambda_short in [Thrun05].
  double short_mean_m = 5.0;
  double max_range_m = 30.0;  ///< maximum range of the beam model; longer ranges count as no return
  int max_beams = 60;         ///< maximum number of beams of a scan that the beam model evaluates

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("z_hit", self.z_hit, between(0.01, 1.0));
    visit("z_short", self.z_short, between(0.0, 1.0));
    visit("z_max", self.z_max, between(0.0, 1.0));
    visit("z_rand", self.z_rand, between(1e-4, 1.0));
    visit("hit_std_m", self.hit_std_m, between(0.01, 2.0));
    visit("short_mean_m", self.short_mean_m, between(0.1, 1000.0));
    visit("max_range_m", self.max_range_m, between(1.0, 1000.0));
    visit("max_beams", self.max_beams, between(1, 10000));
  }
};

}  // namespace patrol::localize
