#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct SonarConeSettings {
  double max_range_m = 1.2;             ///< maximum range of an echo: beyond, the arc is too wide to be useful
  double fov_fraction = 0.7;            ///< fraction of the cone's width in which the echo is assumed to lie
  double ground_range_fraction = 0.85;  ///< fraction of the range to level ground from which an echo may be ground

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_range_m", self.max_range_m, between(0.2, 5.0));
    visit("fov_fraction", self.fov_fraction, between(0.1, 1.0));
    visit("ground_range_fraction", self.ground_range_fraction, between(0.1, 10.0));
  }
};

}  // namespace patrol::plan
