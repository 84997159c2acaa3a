#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "localize/amcl/range_likelihood_settings.h"

namespace patrol::localize {

/// Returns log(likelihood / maximum) of a range with innovation `innovation_m`. The mixture has a normal distribution,
/// an exponential tail for the positive bias of NLOS paths, and a floor that bounds the influence of outliers. It is
/// the beam model's mixture [Thrun05, section 6.3] with the short returns replaced by long ones.
double range_log_likelihood(double innovation_m, const RangeLikelihoodSettings& settings);

/// Range with its geometry relative to the current body.
struct AnchoredRange {
  Eigen::Vector3d p_map_anchor = Eigen::Vector3d::Zero();  ///< m
  /// Position of the antenna at the stamp of the range, in the current level body frame, m.
  Eigen::Vector3d p_body_antenna = Eigen::Vector3d::Zero();
  double range_m = 0.0;
};

/// Measured range minus the distance from anchor to antenna for the level body at `T_map_body`, m.
double range_innovation_m(const AnchoredRange& range, const Pose2& T_map_body);

/// Returns the sum of the log likelihoods of independent ranges at a pose.
double ranges_log_likelihood(const std::vector<AnchoredRange>& ranges, const Pose2& T_map_body,
                             const RangeLikelihoodSettings& settings);
/// Returns the mean likelihood of the ranges at a pose, relative to the maximum, 0 ... 1; 1 without ranges.
double mean_range_likelihood(const std::vector<AnchoredRange>& ranges, const Pose2& T_map_body,
                             const RangeLikelihoodSettings& settings);

}  // namespace patrol::localize
