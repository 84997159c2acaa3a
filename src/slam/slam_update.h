#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// Result of processing one scan.
struct SlamUpdate {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw in map; m, m, rad
  bool is_keyframe = false;
  double effective_sample_size = 0.0;  ///< effective number of particles at the last keyframe, before resampling
  /// Fraction of the scan points that matched a surface, 0 ... 1; 0: odometry only; none: the method does not tell.
  std::optional<double> match_score = {};
  bool resampled = false;
};

}  // namespace patrol::slam
