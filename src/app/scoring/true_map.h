#pragma once

#include "app/record/run_record.h"
#include "app/scenario/scenario.h"
#include "score/visibility.h"
#include "sim/mujoco.h"

namespace patrol::app {

/// Ground truth of a run's map: the world's surfaces at the height of its lidar, and which of them were observable.
struct TrueMap {
  sim::ModelPtr world;
  double lidar_height_m = 0.0;       ///< mean over the run
  double reference_agreement = 0.0;  ///< agreement of the rendered reference with ray casts, a fraction
  score::ReferenceMap reference;     ///< in world
};

TrueMap true_map(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
