#include "localize/amcl/divergence_monitor.h"

#include <algorithm>

namespace patrol::localize {
namespace {

/// Relative shortfall: 0 at the floor and above, 1 at value 0.
double shortfall(double value, double floor) { return floor > 0.0 ? std::clamp(1.0 - value / floor, 0.0, 1.0) : 0.0; }

}  // namespace

void DivergenceMonitor::add_scan_likelihood(double likelihood) {
  const bool is_first = slow_ == 0.0;
  slow_ = is_first ? likelihood : slow_ + settings_.alpha_slow * (likelihood - slow_);
  fast_ = is_first ? likelihood : fast_ + settings_.alpha_fast * (likelihood - fast_);
}

double DivergenceMonitor::range_confidence() const { return 1.0 - shortfall(range_fit_, settings_.min_range_fit); }

double DivergenceMonitor::injection_fraction() const {
  const double sudden = slow_ > 0.0 ? shortfall(settings_.fast_over_slow * fast_, slow_) : 0.0;
  const double worst =
      std::max({sudden, shortfall(scan_fit_, settings_.min_scan_fit), shortfall(range_fit_, settings_.min_range_fit)});
  return std::min(worst, settings_.max_injection_fraction);
}

}  // namespace patrol::localize
