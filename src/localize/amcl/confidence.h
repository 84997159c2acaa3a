#pragma once

#include <Eigen/Core>

#include "core/messages.h"
#include "localize/amcl/confidence_settings.h"

namespace patrol::localize {

/// Evidence for the confidence of a pose estimate.
struct LocalizationEvidence {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in map
  double cluster_weight = 0.0;                           ///< weight of the particle cluster behind the pose
  double scan_fit = 0.0;                                 ///< fraction of the scan points on surfaces of the map
  double range_fit = 1.0;                                ///< 1: the UWB ranges agree with the pose; 0: no range agrees
};

/// Computes the localization confidence: a piecewise linear function of the largest principal standard deviation, times
/// factors for scan fit, range fit and cluster weight. The first detects degenerate corridors, the others kidnapping.
/// The lost state has hysteresis.
LocalizationConfidence assess_confidence(Time stamp, const LocalizationEvidence& evidence, bool was_lost,
                                         const ConfidenceSettings& settings);

}  // namespace patrol::localize
