#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct ConfidenceSettings {
  double std_at_confidence_1_m = 0.05;           ///< largest principal standard deviation up to which its factor is 1
  double std_at_confidence_half_m = 0.25;        ///< standard deviation at which the factor is 0.5
  double std_at_confidence_0_m = 1.0;            ///< standard deviation from which on the factor is 0
  double full_confidence_fit = 0.6;              ///< inlier ratio of the scan from which on its factor is 1
  double zero_confidence_fit = 0.3;              ///< inlier ratio of the scan up to which its factor is 0
  double full_confidence_cluster_weight = 0.95;  ///< cluster weight from which on its factor is 1
  double zero_confidence_cluster_weight = 0.5;   ///< cluster weight up to which its factor is 0
  double lost_threshold = 0.1;                   ///< confidence below which the robot becomes lost
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
