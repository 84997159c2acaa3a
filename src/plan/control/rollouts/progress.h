#pragma once

#include <algorithm>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of missing progress along the path, as a fraction of the reachable progress: 0 full, 1 none, 2 full but
/// backward.
struct ProgressCost {
  double operator()(const Rollout& rollout, const RolloutScene& scene) const {
    const double remaining_m = std::min(scene.reachable_distance_m, scene.path.length_m() - scene.along_m);
    if (remaining_m < 1e-6) return 0.0;
    const double from_m = std::max(0.0, scene.along_m - scene.reachable_distance_m);
    const double reached_m =
        scene.path.project(rollout.T_map_body.back().position(), from_m, scene.along_m + scene.reachable_distance_m)
            .along_m;
    return std::clamp(1.0 - (reached_m - scene.along_m) / remaining_m, 0.0, 2.0);
  }
};

}  // namespace patrol::plan
