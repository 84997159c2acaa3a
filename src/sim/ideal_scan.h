#pragma once

#include <vector>

#include "core/beam_return.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// Ideal lidar: level, instantaneous, with uniformly spaced beams over the full circle.
struct IdealScanSettings {
  int beams = 720;
  double range_max_m = 30.0;
  double max_incidence_deg = 85.0;  ///< maximum angle of incidence; surfaces beyond it return nothing
};

/// Returns the hits of an ideal lidar at `p_world_m`, on static and moving objects of `scene`. Beams without a hit are
/// omitted.
std::vector<BeamReturn> ideal_scan(const LidarScene& scene, const Eigen::Vector3d& p_world_m,
                                   const IdealScanSettings& settings);

}  // namespace patrol::sim
