#pragma once

#include <vector>

#include "app/scenario.h"
#include "core/grid.h"
#include "score/localizability.h"

namespace patrol::app {

/// The oracle at one place that the robot could stand at.
struct LocalizablePlace {
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
  score::Localizability truth;
};

struct LocalizabilityMap {
  OccupancyGrid surfaces;  ///< in world, at the lidar's height
  double step_m = 0.5;     ///< from place to place
  std::vector<LocalizablePlace> places;
};

/// Every place on a grid of `step_m` from the surveyed start on that can be reached between the world's outermost surfaces without coming
/// nearer than 0.4 m to one. Throws InputError when that is none.
LocalizabilityMap map_localizability(const Scenario& scenario, const ScenarioFiles& files, double step_m);

}  // namespace patrol::app
