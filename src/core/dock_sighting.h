#pragma once

#include <Eigen/Core>

#include "core/frames.h"
#include "core/time.h"

namespace patrol {

/// The charging post, found in one scan.
struct DockSighting {
  Time stamp{};
  Pose2 T_level_docked;  ///< where the level body would stand when docked, from where it stands now
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in level; m, m, rad
  double explained = 0.0;  ///< share of the beams about the post that end where its outline says
  double rms_m = 0.0;      ///< of those, between range and outline
};

}  // namespace patrol
