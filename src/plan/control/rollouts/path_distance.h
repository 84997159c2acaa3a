#pragma once

#include <algorithm>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of the distance from the path, averaged over the middle and the end of the rollout: 1 at `full_m` or more.
struct PathDistanceCost {
  double full_m = 0.5;

  double operator()(const Rollout& rollout, const RolloutScene& scene) const {
    const double to_m = scene.along_m + 1.5 * scene.reachable_distance_m + full_m;
    const auto distance_m = [&](std::size_t i) {
      return scene.path.project(rollout.T_map_body[i].position(), scene.along_m, to_m).distance_m;
    };
    const std::size_t last = rollout.T_map_body.size() - 1;
    return std::min(1.0, 0.5 * (distance_m(last / 2) + distance_m(last)) / full_m);
  }
};

}  // namespace patrol::plan
