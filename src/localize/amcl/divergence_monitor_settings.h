#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the injection of particles when the localization diverges (divergence_monitor.h).
struct DivergenceMonitorSettings {
  /// Filter constant of the long-term average of the scan likelihood, per update [Thrun05, table 8.3].
  double alpha_slow = 0.02;
  /// Filter constant of the short-term average of the scan likelihood, per update [Thrun05, table 8.3], and of the mean
  /// inlier ratio, per scan.
  double alpha_fast = 0.2;
  /// Ratio of the long-term to the short-term average of the scan likelihood above which particles are injected, nu in
  /// [Gutmann02].
  double fast_over_slow = 1.5;
  double alpha_range = 0.1;  ///< filter constant of the mean range likelihood, per range
  /// Mean inlier ratio of the scans below which particles are injected, regardless of the averages of the scan
  /// likelihood.
  double min_scan_fit = 0.4;
  double min_range_fit = 0.25;  ///< mean range likelihood, relative to its maximum, below which particles are injected
  double max_injection_fraction = 0.5;  ///< maximum fraction of the particles that are replaced by injected ones

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
