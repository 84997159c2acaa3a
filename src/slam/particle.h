#pragma once

#include "core/frames.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// One hypothesis: where the body was at the last keyframe, and the map that follows from its path.
struct Particle {
  Pose2 T_map_body;
  double log_weight = 0.0;
  GridMap map;
};

}  // namespace patrol::slam
