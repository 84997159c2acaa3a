#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the global search for the pose on the whole map (global_search.h).
struct GlobalSearchSettings {
  double step_m = 0.4;           ///< spacing of the coarse position grid of a global search
  double step_rad = 0.105;       ///< spacing of the coarse heading grid of a global search; 0.105: 6 degrees
  int max_beams = 60;            ///< maximum number of beams of a scan that a global search uses
  int coarse_samples = 1000;     ///< number of samples of coarse cells, drawn by their likelihood, that are refined
  double min_clearance_m = 0.2;  ///< minimum distance of a candidate position from walls

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("step_m", self.step_m, between(0.05, 5.0));
    visit("step_rad", self.step_rad, between(0.01, 1.6));
    visit("max_beams", self.max_beams, between(10, 10000));
    visit("coarse_samples", self.coarse_samples, between(1, 1000000));
    visit("min_clearance_m", self.min_clearance_m, between(0.0, 5.0));
  }
};

}  // namespace patrol::localize
