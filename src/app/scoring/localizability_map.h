#pragma once

#include <functional>
#include <vector>

#include "app/scenario/scenario.h"
#include "core/grid.h"
#include "score/localizability.h"

namespace patrol::app {

/// Localizability at one position that the robot could reach.
struct LocalizabilitySample {
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
  score::Localizability truth;
};

struct LocalizabilityMap {
  OccupancyGrid surfaces;  ///< in world, at the lidar's height
  double step_m = 0.5;     ///< grid spacing of the positions
  std::vector<LocalizabilitySample> positions;
};

/// Computes localizability at every reachable position on a grid of `step_m` that contains the surveyed start.
/// Reachable positions are connected to the start and at least 0.4 m from the surfaces. Throws InputError if there are
/// none. `on_progress` gets the completed fraction, in [0, 1].
LocalizabilityMap map_localizability(const Scenario& scenario, const ScenarioFiles& files, double step_m,
                                     const std::function<void(double)>& on_progress);

}  // namespace patrol::app
