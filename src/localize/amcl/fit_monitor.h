#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct FitMonitorSettings {
  double slow_rate = 0.02;        ///< of the long average of the scan's likelihood, per update
  double fast_rate = 0.2;         ///< of the short one
  double fast_over_slow = 1.5;    ///< injection begins when the short one falls below the long one over this
  double range_rate = 0.1;        ///< of the average over ranges, per range
  double min_scan_fit = 0.4;      ///< share of the scan on surfaces below which particles are injected, however long it has been so
  double min_range_fit = 0.25;    ///< the same for the mean likelihood of ranges
  double max_injection = 0.5;     ///< share of the particles

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("slow_rate", self.slow_rate, between(1e-4, 1.0));
    visit("fast_rate", self.fast_rate, between(1e-3, 1.0));
    visit("fast_over_slow", self.fast_over_slow, between(1.0, 10.0));
    visit("range_rate", self.range_rate, between(1e-3, 1.0));
    visit("min_scan_fit", self.min_scan_fit, between(0.0, 1.0));
    visit("min_range_fit", self.min_range_fit, between(0.0, 1.0));
    visit("max_injection", self.max_injection, between(0.0, 1.0));
  }
};

/// Notices that the measurements no longer fit to where the particles are, and says what share of them to replace.
///
/// Augmented MCL (Thrun et al. 2005, table 8.3): short against long average of the measurements' likelihood, injection
/// max(0, 1 - nu w_fast / w_slow) with nu > 1 against false alarms (Gutmann and Fox, IROS 2002). Two floors stand beside
/// it: the long average forgets what a good fit is like, and along a tunnel a kidnap shows in the ranges alone.
class FitMonitor {
 public:
  explicit FitMonitor(const FitMonitorSettings& settings) : settings_(settings) {}

  /// Likelihood of a scan, mean over the particles, next to the best possible one, 0 ... 1.
  void add_scan_likelihood(double likelihood);
  /// Share of a scan that lies on surfaces of the map, 0 ... 1.
  void add_scan_fit(double share) { scan_fit_ += settings_.fast_rate * (share - scan_fit_); }
  /// Likelihood of one range next to the best possible one, 0 ... 1.
  void add_range(double likelihood) { range_fit_ += settings_.range_rate * (likelihood - range_fit_); }
  /// Forgets: the robot has been placed anew.
  void reset() { *this = FitMonitor(settings_); }

  double scan_fit() const { return scan_fit_; }
  double range_fit() const { return range_fit_; }
  /// 1 while the ranges fit as well as they should, falling to 0 with them.
  double range_trust() const;
  /// Share of the particles to replace, 0 ... max_injection.
  double injection_share() const;

 private:
  FitMonitorSettings settings_;
  double slow_ = 0.0, fast_ = 0.0;  ///< 0: no scan yet
  double scan_fit_ = 1.0;
  double range_fit_ = 1.0;
};

}  // namespace patrol::localize
