#pragma once

#include <vector>

#include "studies/landmarks/landmark_map.h"

namespace patrol::studies {

struct AssociationSettings {
  bool is_known = true;  ///< true: observations contain the landmark number
  double gate = 9.21;    ///< maximum squared Mahalanobis distance of a match: 99 % of chi^2 with 2 degrees of freedom
  /// Minimum squared Mahalanobis distance from all landmarks of a new landmark; observations between the two limits are
  /// ignored.
  double new_landmark = 25.0;
};

/// Result for an observation that matches no landmark and does not start a new one.
inline constexpr int kUnmatched = -1;

/// Data association, [observation] -> index of the landmark, the next free index for a new landmark, or kUnmatched.
/// With unknown association, each observation is assigned to the landmark of maximum likelihood [Montemerlo03], and
/// each landmark at most once.
std::vector<int> associate(const LandmarkMap& map, const Pose2& T_map_body,
                           const std::vector<RangeBearing>& observations, const RangeBearingNoise& noise,
                           const AssociationSettings& settings);

}  // namespace patrol::studies
