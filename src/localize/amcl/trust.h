#pragma once

#include <Eigen/Core>

#include "core/messages.h"
#include "core/settings.h"

namespace patrol::localize {

struct TrustSettings {
  double sure_std_m = 0.05;       ///< weakest deviation up to which trust is 1,
  double doubtful_std_m = 0.25;   ///< at which it is 0.5,
  double hopeless_std_m = 1.0;    ///< and from which on it is 0
  double good_fit = 0.6;          ///< share of the scan on the map's surfaces from which on the map fits
  double bad_fit = 0.3;           ///< and up to which it does not
  double decided_weight = 0.95;   ///< share of the belief behind the pose from which on it is decided,
  double undecided_weight = 0.5;  ///< and up to which it is not
  double lost_below = 0.1;        ///< less trust than this is being lost
  double found_above = 0.2;       ///< who was lost is found with more than this, and only when the pose is decided

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

/// What there is to judge a pose by.
struct BeliefEvidence {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in map
  double clump_weight = 0.0;  ///< share of the belief that stands behind the pose
  double scan_fit = 0.0;      ///< share of the scan's points that lie on the map's surfaces
  double range_fit = 1.0;     ///< 1: the UWB ranges are as the pose has them; 0: none is
};

/// trust = how narrow x how well founded: piecewise linear in the deviation along the weakest direction, times the fits and the
/// clump's share. A degenerate corridor shows in the first, a kidnap in the others. Being lost has hysteresis.
LocalizationTrust assess_trust(Time stamp, const BeliefEvidence& evidence, bool was_lost, const TrustSettings& settings);

}  // namespace patrol::localize
