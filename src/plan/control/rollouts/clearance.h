#pragma once

#include <algorithm>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of nearness to obstacles: 0 from `comfortable_m` on, growing quadratically to 1 at contact.
struct ClearanceCost {
  double comfortable_m = 0.4;

  double operator()(const Rollout& rollout, const RolloutScene&) const {
    const double missing = std::clamp(1.0 - rollout.min_clearance_m / comfortable_m, 0.0, 1.0);
    return missing * missing;
  }
};

}  // namespace patrol::plan
