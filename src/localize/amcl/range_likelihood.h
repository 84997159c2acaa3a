#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/settings.h"

namespace patrol::localize {

struct RangeLikelihoodSettings {
  double range_std_m = 0.15;      ///< of a range in plain view; more than the radio's, because neighbouring ranges err together
  double blocked_share = 0.1;     ///< likelihood of a path just barely blocked, next to a true range
  double blocked_excess_m = 0.5;  ///< mean of what a blocked path adds
  double outlier_share = 0.02;    ///< likelihood of any other range

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(0.005, 5.0));
    visit("blocked_share", self.blocked_share, between(0.0, 0.4));
    visit("blocked_excess_m", self.blocked_excess_m, between(0.01, 10.0));
    visit("outlier_share", self.outlier_share, between(1e-6, 0.4));
  }
};

/// log(likelihood / largest) of a range that is longer than expected by `excess_m`: a normal distribution, an exponential
/// tail of blocked paths, which only lengthen, and a floor that bounds what one bad range may do. The beam model's
/// mixture (Thrun et al. 2005, section 6.3) with its short returns turned into long ones.
double range_log_likelihood(double excess_m, const RangeLikelihoodSettings& settings);

/// A range as it is compared with poses of the body now.
struct AnchoredRange {
  Eigen::Vector3d p_map_anchor = Eigen::Vector3d::Zero();   ///< m
  Eigen::Vector3d p_body_antenna = Eigen::Vector3d::Zero();  ///< where the antenna was at the range's stamp, in the level body of now, m
  double range_m = 0.0;
};

/// The range less the distance from the anchor to the antenna, if the level body is at `T_map_body`, m.
double range_excess_m(const AnchoredRange& range, const Pose2& T_map_body);

}  // namespace patrol::localize
