#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// Rigid motion that minimizes the sum of squared distances of point pairs, in closed form [Yu23, eqs. 9 to 12]. Both
/// sets are centered, then the rotation is estimated, then T = mu_p - R mu_q. At least one pair is required.
Pose2 fit_rigid_motion(const std::vector<Eigen::Vector2d>& points_target,
                       const std::vector<Eigen::Vector2d>& points_source);

/// Scales a small motion to a fraction of its duration, or to a multiple, at constant velocity.
inline Pose2 scaled_motion(const Pose2& motion, double factor) {
  return {factor * motion.x, factor * motion.y, factor * motion.yaw};
}

}  // namespace patrol::slam
