#pragma once

#include <vector>

#include "core/surface_return.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// A lidar without any imperfection: level, in an instant, of as many beams as asked, evenly all around.
struct IdealScanSettings {
  int beams = 720;
  double range_max_m = 30.0;
  double grazing_deg = 85.0;  ///< a surface met flatter than this sends nothing back
};

/// What stands still and moves in `scene`, seen from `p_world_m`; beams that meet nothing are left out.
std::vector<SurfaceReturn> ideal_scan(const LidarScene& scene, const Eigen::Vector3d& p_world_m, const IdealScanSettings& settings);

}  // namespace patrol::sim
