#pragma once

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// What a scan has told of where the body is.
struct SlamUpdate {
  Pose2 T_map_body;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in map; m, m, rad
  bool is_keyframe = false;
  double effective_sample_size = 0.0;  ///< of particles, at the last keyframe, before any resampling
  double match_score = 0.0;            ///< share of the scan's points that met a surface, 0 ... 1; 0: odometry alone
  bool resampled = false;
};

}  // namespace patrol::slam
