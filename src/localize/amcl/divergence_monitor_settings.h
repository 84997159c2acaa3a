#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct DivergenceMonitorSettings {
  double alpha_slow = 0.02;     ///< filter constant of the long-term average of the scan likelihood, per update
  double alpha_fast = 0.2;      ///< filter constant of the short-term average, per update
  double fast_over_slow = 1.5;  ///< ratio of the long-term to the short-term average above which particles are injected
  double alpha_range = 0.1;     ///< filter constant of the average range likelihood, per range
  /// Inlier ratio of the scan below which particles are injected, regardless of the averages.
  double min_scan_fit = 0.4;
  double min_range_fit = 0.25;          ///< mean range likelihood below which particles are injected
  double max_injection_fraction = 0.5;  ///< maximum fraction of injected particles

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("alpha_slow", self.alpha_slow, between(1e-4, 1.0));
    visit("alpha_fast", self.alpha_fast, between(1e-3, 1.0));
    visit("fast_over_slow", self.fast_over_slow, between(1.0, 10.0));
    visit("alpha_range", self.alpha_range, between(1e-3, 1.0));
    visit("min_scan_fit", self.min_scan_fit, between(0.0, 1.0));
    visit("min_range_fit", self.min_range_fit, between(0.0, 1.0));
    visit("max_injection_fraction", self.max_injection_fraction, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
