#pragma once

#include "localize/amcl/divergence_monitor_settings.h"

namespace patrol::localize {

/// Monitors the measurement likelihood of the particles and computes the fraction of particles to replace.
///
/// Augmented MCL [Thrun05, table 8.3]: compares the short-term with the long-term average of the likelihood. The
/// injection is max(0, 1 - nu w_fast / w_slow), with nu > 1 against false alarms [Gutmann02]. Extension: two absolute
/// thresholds, because the long-term average adapts to a poor fit, and because kidnapping along a tunnel is visible in
/// the ranges only.
class DivergenceMonitor {
 public:
  explicit DivergenceMonitor(const DivergenceMonitorSettings& settings) : settings_(settings) {}

  /// Adds the likelihood of a scan, averaged over the particles, relative to the maximum, 0 ... 1.
  void add_scan_likelihood(double likelihood);
  /// Adds the fraction of a scan on surfaces of the map, 0 ... 1.
  void add_scan_fit(double fraction) { scan_fit_ += settings_.alpha_fast * (fraction - scan_fit_); }
  /// Adds the likelihood of a range relative to the maximum, 0 ... 1.
  void add_range(double likelihood) { range_fit_ += settings_.alpha_range * (likelihood - range_fit_); }
  /// Sets the mean range likelihood of a pose that does not continue the former one.
  void set_range_fit(double likelihood) { range_fit_ = likelihood; }
  /// Clears all averages after the pose was set externally.
  void reset() { *this = DivergenceMonitor(settings_); }

  double scan_fit() const { return scan_fit_; }
  double range_fit() const { return range_fit_; }
  /// Range factor of the confidence: 1 while the mean range likelihood is sufficient, decreasing to 0 with it.
  double range_confidence() const;
  /// Fraction of the particles to replace, 0 ... max_injection_fraction.
  double injection_fraction() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(slow_, fast_, scan_fit_, range_fit_);
  }

 private:
  DivergenceMonitorSettings settings_;
  double slow_ = 0.0, fast_ = 0.0;  ///< 0: no scan yet
  double scan_fit_ = 1.0;
  double range_fit_ = 1.0;
};

}  // namespace patrol::localize
