#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the confidence of the localization (confidence.h). The confidence is the product of factors for the
/// standard deviation of the position, the scan, the ranges and the dominant particle cluster.
struct ConfidenceSettings {
  /// Maximum standard deviation of the position, along its major axis, with a confidence factor of 1.
  double std_at_confidence_1_m = 0.05;
  /// Standard deviation of the position, along its major axis, with a confidence factor of 0.5.
  double std_at_confidence_half_m = 0.25;
  /// Minimum standard deviation of the position, along its major axis, with a confidence factor of 0.
  double std_at_confidence_0_m = 1.0;
  double full_confidence_fit = 0.6;  ///< minimum inlier ratio of the scan with a confidence factor of 1
  double zero_confidence_fit = 0.3;  ///< maximum inlier ratio of the scan with a confidence factor of 0
  /// Minimum weight of the dominant particle cluster with a confidence factor of 1.
  double full_confidence_cluster_weight = 0.95;
  /// Maximum weight of the dominant particle cluster with a confidence factor of 0.
  double zero_confidence_cluster_weight = 0.5;
  double lost_threshold = 0.1;  ///< confidence below which the robot becomes lost
  /// Confidence above which a lost robot recovers, if the cluster weight is at least full_confidence_cluster_weight.
  double found_threshold = 0.2;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("std_at_confidence_1_m", self.std_at_confidence_1_m, between(0.0, 100.0));
    visit("std_at_confidence_half_m", self.std_at_confidence_half_m, between(0.0, 100.0));
    visit("std_at_confidence_0_m", self.std_at_confidence_0_m, between(0.0, 100.0));
    visit("full_confidence_fit", self.full_confidence_fit, between(0.0, 1.0));
    visit("zero_confidence_fit", self.zero_confidence_fit, between(0.0, 1.0));
    visit("full_confidence_cluster_weight", self.full_confidence_cluster_weight, between(0.0, 1.0));
    visit("zero_confidence_cluster_weight", self.zero_confidence_cluster_weight, between(0.0, 1.0));
    visit("found_threshold", self.found_threshold, between(0.0, 1.0));
    visit("lost_threshold", self.lost_threshold, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
