#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plan/control/rollouts/rollout.h"

namespace patrol::plan {

/// Cost of the angle between the heading at the end and a point ahead on the path: 0 along the path, 1 backward.
struct PathHeadingCost {
  double look_ahead_m = 0.6;

  double operator()(const Rollout& rollout, const RolloutScene& scene) const {
    const Pose2& end = rollout.T_map_body.back();
    const double along_m =
        scene.path.project(end.position(), scene.along_m, scene.along_m + scene.reachable_distance_m).along_m +
        look_ahead_m;
    const Eigen::Vector2d ahead = scene.path.point_at(along_m) - end.position();
    if (ahead.norm() < 0.05) return 0.0;
    return std::abs(wrap_angle(std::atan2(ahead.y(), ahead.x()) - end.yaw)) / std::numbers::pi;
  }
};

}  // namespace patrol::plan
