#pragma once

#include <optional>
#include <vector>

#include "studies/landmark_methods.h"

namespace patrol::studies {

/// Estimates of a method along a run.
struct LandmarkTrack {
  std::vector<LandmarkSlamEstimate> estimates;            ///< [step]
  std::vector<std::optional<Eigen::Vector2d>> landmarks;  ///< [landmark], at the end, in map
  double seconds = 0.0;                                   ///< processor time

  std::vector<Pose2> poses() const;  ///< [step], body in map
};

LandmarkTrack follow(const LandmarkMethod& method, const LandmarkWorld& world, const LandmarkRun& run,
                     std::uint64_t seed);

}  // namespace patrol::studies
