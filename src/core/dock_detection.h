#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// Detection of the charging post in one scan.
struct DockDetection {
  Time stamp{};
  Pose2 T_level_docked;                                  ///< pose of `level` when docked, in the present `level` frame
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< covariance of x, y, yaw of `T_level_docked`; m, m, rad
  double inlier_ratio = 0.0;  ///< inlier ratio: fraction of the beams around the post that end on its outline
  double rms_m = 0.0;         ///< root mean square range residual of the inliers, m
};

}  // namespace patrol
