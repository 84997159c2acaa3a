#pragma once

#include <vector>

#include "slam/landmarks/landmark_map.h"

namespace patrol::slam {

struct AssociationSettings {
  bool is_known = true;          ///< sights tell which landmark they are of
  double gate = 9.21;            ///< squared Mahalanobis distance up to which a sight may be of a landmark: 99 % of chi^2 with 2
  double new_landmark = 25.0;    ///< beyond which of all of them it is of a new one; between the two it is left out
};

/// A sight that is of no landmark, and not good for a new one either.
inline constexpr int kUnmatched = -1;

/// [sight] -> number of the landmark, one beyond all that are known for a new one, or kUnmatched. Unknown: each sight takes the landmark
/// under which it is most probable (maximum likelihood, Montemerlo et al. 2003), no landmark twice.
std::vector<int> associate(const LandmarkMap& map, const Pose2& T_map_body, const std::vector<RangeBearing>& seen, const RangeBearingNoise& noise,
                           const AssociationSettings& settings);

}  // namespace patrol::slam
