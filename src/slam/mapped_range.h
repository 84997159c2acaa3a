#pragma once

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// Mean of the UWB ranges to one anchor near one pose of the path of the mapping.
struct MappedRange {
  int anchor = 0;
  Pose2 T_map_body;
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();  ///< antenna in level, height above the ground
  double range_m = 0.0;                                       ///< mean, at that pose
  int count = 0;                                              ///< number of ranges
};

}  // namespace patrol::slam
