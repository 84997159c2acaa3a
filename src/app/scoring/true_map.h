#pragma once

#include "app/run/run_record.h"
#include "app/scenario.h"
#include "score/visibility.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// What a run's map is judged by: the world's surfaces at the height that its lidar had, and which of them it could see.
struct TrueMap {
  sim::ModelPtr world;
  double lidar_height_m = 0.0;   ///< the mean of the run
  double reference_agreement = 0.0;  ///< of the reference's render with rays, a share
  score::ReferenceMap reference;  ///< in world
};

TrueMap true_map(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
