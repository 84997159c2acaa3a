#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/settings.h"

namespace patrol::localize {

struct RangeLikelihoodSettings {
  /// Standard deviation of a LOS range; larger than that of the radio, because consecutive ranges have correlated
  /// errors.
  double range_std_m = 0.15;
  double nlos_probability = 0.1;     ///< likelihood of a marginal NLOS path relative to that of an exact range
  double nlos_bias_m = 0.5;  ///< mean NLOS bias
  double outlier_probability = 0.02;    ///< likelihood of any other range

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(0.005, 5.0));
    visit("nlos_probability", self.nlos_probability, between(0.0, 0.4));
    visit("nlos_bias_m", self.nlos_bias_m, between(0.01, 10.0));
    visit("outlier_probability", self.outlier_probability, between(1e-6, 0.4));
  }
};

/// Returns log(likelihood / maximum) of a range with innovation `innovation_m`. The mixture has a normal distribution, an
/// exponential tail for the positive bias of NLOS paths, and a floor that bounds the influence of outliers. It is the
/// beam model's mixture [Thrun05, section 6.3] with the short returns replaced by long ones.
double range_log_likelihood(double innovation_m, const RangeLikelihoodSettings& settings);

/// Range with its geometry relative to the current body.
struct AnchoredRange {
  Eigen::Vector3d p_map_anchor = Eigen::Vector3d::Zero();   ///< m
  /// Position of the antenna at the stamp of the range, in the current level body frame, m.
  Eigen::Vector3d p_body_antenna = Eigen::Vector3d::Zero();
  double range_m = 0.0;
};

/// Measured range minus the distance from anchor to antenna for the level body at `T_map_body`, m.
double range_innovation_m(const AnchoredRange& range, const Pose2& T_map_body);

}  // namespace patrol::localize
