#include "localize/amcl/trust.h"

#include <algorithm>
#include <cmath>

#include "core/symmetric_axes.h"

namespace patrol::localize {
namespace {

/// Linear ramp: 0 up to `low`, 1 from `high` on.
double ramp(double value, double low, double high) {
  if (high <= low) return value < low ? 0.0 : 1.0;
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

}  // namespace

LocalizationTrust assess_trust(Time stamp, const BeliefEvidence& evidence, bool was_lost, const TrustSettings& settings) {
  if (!evidence.covariance.allFinite()) return {.stamp = stamp, .is_lost = true};
  const SymmetricAxes axes = symmetric_axes(evidence.covariance.topLeftCorner<2, 2>());
  LocalizationTrust trust{.stamp = stamp, .weak_std_m = std::sqrt(std::max(0.0, axes.large)), .weak_direction_rad = axes.large_direction_rad};
  const double narrow = 1.0 - 0.5 * ramp(trust.weak_std_m, settings.sure_std_m, settings.doubtful_std_m) -
                        0.5 * ramp(trust.weak_std_m, settings.doubtful_std_m, settings.hopeless_std_m);
  const double decided = ramp(evidence.clump_weight, settings.undecided_weight, settings.decided_weight);
  const double founded = decided * ramp(evidence.scan_fit, settings.bad_fit, settings.good_fit) * evidence.range_fit;
  trust.trust = std::clamp(narrow * founded, 0.0, 1.0);
  const bool is_found = was_lost ? trust.trust > settings.found_above && decided >= 1.0 : trust.trust >= settings.lost_below;
  trust.is_lost = !is_found;
  return trust;
}

}  // namespace patrol::localize
