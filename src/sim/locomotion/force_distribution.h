#pragma once

#include <Eigen/Core>

#include <array>

#include "sim/locomotion/gait.h"

namespace patrol::sim {

using FootVectors = std::array<Eigen::Vector3d, kNumLegs>;  ///< [leg]
using FootFlags = std::array<bool, kNumLegs>;              ///< [leg]

struct FrictionLimits {
  double coefficient = 0.6;
  double min_normal_n = 5.0;
  double max_normal_n = 220.0;
};

/// Ground forces of the stance feet that together give the wrench (force, moment about the origin of `feet`), as small as
/// possible; then kept inside each foot's friction pyramid. All in one frame with z up; N and N m. Feet in the air get zero.
FootVectors distribute_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, const FootVectors& feet,
                              const FootFlags& is_stance, const FrictionLimits& limits);

}  // namespace patrol::sim
