#include "localize/amcl/confidence.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/principal_axes.h"

namespace patrol::localize {
namespace {

/// Linear ramp: 0 up to `low`, 1 from `high` on.
double ramp(double value, double low, double high) {
  if (high <= low) return value < low ? 0.0 : 1.0;
  return std::clamp((value - low) / (high - low), 0.0, 1.0);
}

}  // namespace

LocalizationConfidence assess_confidence(Time stamp, const LocalizationEvidence& evidence, bool was_lost,
                                         const ConfidenceSettings& settings) {
  if (!evidence.covariance.allFinite()) return {.stamp = stamp, .is_lost = true};
  const PrincipalAxes axes = principal_axes(evidence.covariance.topLeftCorner<2, 2>());
  LocalizationConfidence confidence{.stamp = stamp,
                                    .max_std_m = std::sqrt(std::max(0.0, axes.large)),
                                    .max_std_direction_rad = axes.large_direction_rad};
  const double std_factor =
      1.0 - 0.5 * ramp(confidence.max_std_m, settings.std_at_confidence_1_m, settings.std_at_confidence_half_m) -
      0.5 * ramp(confidence.max_std_m, settings.std_at_confidence_half_m, settings.std_at_confidence_0_m);
  const double cluster_factor =
      ramp(evidence.cluster_weight, settings.zero_confidence_cluster_weight, settings.full_confidence_cluster_weight);
  const double evidence_factor = cluster_factor *
                                 ramp(evidence.scan_fit, settings.zero_confidence_fit, settings.full_confidence_fit) *
                                 evidence.range_fit;
  confidence.confidence = std::clamp(std_factor * evidence_factor, 0.0, 1.0);
  const bool is_found = was_lost ? confidence.confidence > settings.found_threshold && cluster_factor >= 1.0
                                 : confidence.confidence >= settings.lost_threshold;
  confidence.is_lost = !is_found;
  return confidence;
}

}  // namespace patrol::localize
