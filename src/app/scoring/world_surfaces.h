#pragma once

#include "app/scenario/scenario.h"
#include "core/grid.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// Surfaces of a scenario's world at the height of its robot's lidar (mapping_lidar.h) at the start; available before a
/// run.
struct WorldSurfaces {
  sim::ModelPtr world;
  double lidar_height_m = 0.0;
  OccupancyGrid surfaces;  ///< in world, at that height (render/reference_map.h)
};

WorldSurfaces world_surfaces(const ScenarioFiles& files, double resolution_m);

}  // namespace patrol::app
