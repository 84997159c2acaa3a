#pragma once

#include "app/scenario/scenario.h"
#include "app/scoring/true_map.h"
#include "score/run/run_score.h"

namespace patrol::app {

/// References for the evaluation of a run of this scenario. `truth` must outlive the result.
score::RunReferences run_references(const Scenario& scenario, const ScenarioFiles& files, const TrueMap& truth);

}  // namespace patrol::app
