#pragma once

#include "app/scenario.h"
#include "core/grid.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// What a scenario's world shows to the lidar of its robot, which stands at the start: known before any run.
struct WorldSurfaces {
  sim::ModelPtr world;
  double lidar_height_m = 0.0;
  OccupancyGrid surfaces;  ///< in world, at that height (render/reference_map.h)
};

WorldSurfaces world_surfaces(const ScenarioFiles& files, double resolution_m);

}  // namespace patrol::app
