#pragma once

#include <cmath>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of the change of speed and yaw rate from the current motion, each as a fraction of its limit.
struct CommandChangeCost {
  double operator()(const Rollout& rollout, const RolloutScene& scene) const {
    return std::abs(rollout.vx_mps - scene.twist.linear.x()) / scene.max_speed_mps +
           std::abs(rollout.yaw_rate_radps - scene.twist.angular.z()) / scene.max_yaw_rate_radps;
  }
};

}  // namespace patrol::plan
