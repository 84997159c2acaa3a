#pragma once

#include <array>

#include <Eigen/Core>

#include "sim/locomotion/gait.h"

namespace patrol::sim {

using FootVectors = std::array<Eigen::Vector3d, kNumLegs>;   ///< vectors, [leg]
using FootMatrices = std::array<Eigen::Matrix3d, kNumLegs>;  ///< matrices, [leg]
using FootFlags = std::array<bool, kNumLegs>;                ///< flags, [leg]

struct FrictionLimits {
  double coefficient = 0.6;
  double min_normal_n = 5.0;
  double max_normal_n = 220.0;
  /// The others give the rest of the wrench for feet that would have to pull; false: they are only clipped.
  bool redistributes = true;
};

/// Returns the minimum-norm ground forces of the stance feet for a wrench: force, and moment about the origin of
/// `feet`. Feet that would have to pull get the minimum, and the others the rest of the wrench. Each force is then
/// clipped to the friction pyramid of its foot. All in one frame with z up; N and N m. Swing feet get zero.
FootVectors distribute_wrench(const Eigen::Vector3d& force, const Eigen::Vector3d& moment, const FootVectors& feet,
                              const FootFlags& is_stance, const FrictionLimits& limits);

}  // namespace patrol::sim
