#pragma once

#include <Eigen/Core>

#include "core/messages.h"
#include "core/settings.h"

namespace patrol::localize {

struct TrustSettings {
  double sure_std_m = 0.05;       ///< largest principal standard deviation up to which its factor is 1
  double doubtful_std_m = 0.25;   ///< standard deviation at which the factor is 0.5
  double hopeless_std_m = 1.0;    ///< standard deviation from which on the factor is 0
  double good_fit = 0.6;          ///< inlier ratio of the scan from which on its factor is 1
  double bad_fit = 0.3;           ///< inlier ratio of the scan up to which its factor is 0
  double decided_weight = 0.95;   ///< cluster weight from which on its factor is 1
  double undecided_weight = 0.5;  ///< cluster weight up to which its factor is 0
  double lost_below = 0.1;        ///< the robot becomes lost below this confidence
  /// A lost robot recovers above this confidence, if the cluster weight is at least decided_weight.
  double found_above = 0.2;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sure_std_m", self.sure_std_m, between(0.0, 100.0));
    visit("doubtful_std_m", self.doubtful_std_m, between(0.0, 100.0));
    visit("hopeless_std_m", self.hopeless_std_m, between(0.0, 100.0));
    visit("good_fit", self.good_fit, between(0.0, 1.0));
    visit("bad_fit", self.bad_fit, between(0.0, 1.0));
    visit("decided_weight", self.decided_weight, between(0.0, 1.0));
    visit("undecided_weight", self.undecided_weight, between(0.0, 1.0));
    visit("found_above", self.found_above, between(0.0, 1.0));
    visit("lost_below", self.lost_below, between(0.0, 1.0));
  }
};

/// Evidence for the confidence of a pose estimate.
struct BeliefEvidence {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in map
  double clump_weight = 0.0;  ///< weight of the particle cluster behind the pose
  double scan_fit = 0.0;      ///< fraction of the scan points on surfaces of the map
  double range_fit = 1.0;     ///< 1: the UWB ranges agree with the pose; 0: no range agrees
};

/// Computes the localization confidence: a piecewise linear function of the largest principal standard deviation, times
/// factors for scan fit, range fit and cluster weight. The first detects degenerate corridors, the others kidnapping.
/// The lost state has hysteresis.
LocalizationTrust assess_trust(Time stamp, const BeliefEvidence& evidence, bool was_lost, const TrustSettings& settings);

}  // namespace patrol::localize
