#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the likelihood-field model of a scan (likelihood_field.h).
struct LikelihoodFieldSettings {
  /// Standard deviation of the distance of a beam's end from the nearest surface of the map: range noise, map error and
  /// tilt.
  double hit_std_m = 0.1;
  double z_rand = 0.05;  ///< likelihood of a beam's end far from all surfaces, relative to an end on a surface
  int max_beams = 180;   ///< maximum number of evaluated beams of a scan; the cost is proportional to it

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("hit_std_m", self.hit_std_m, between(0.01, 2.0));
    visit("z_rand", self.z_rand, between(1e-4, 0.5));
    visit("max_beams", self.max_beams, between(10, 10000));
  }
};

}  // namespace patrol::localize
