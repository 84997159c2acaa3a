#pragma once

#include <cmath>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of the change of speed, yaw rate and lateral speed from the current motion, each as a fraction of its limit.
struct CommandChangeCost {
  double operator()(const Rollout& rollout, const RolloutScene& scene) const {
    const double change = std::abs(rollout.vx_mps - scene.twist.linear.x()) / scene.max_speed_mps +
                          std::abs(rollout.yaw_rate_radps - scene.twist.angular.z()) / scene.max_yaw_rate_radps;
    if (scene.max_lateral_speed_mps <= 0.0) return change;
    return change + std::abs(rollout.vy_mps - scene.twist.linear.y()) / scene.max_lateral_speed_mps;
  }
};

}  // namespace patrol::plan
