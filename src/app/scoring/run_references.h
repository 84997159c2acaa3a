#pragma once

#include <vector>

#include "app/scenario/scenario.h"
#include "app/scoring/true_map.h"
#include "score/run/run_score.h"

namespace patrol::app {

/// References for the evaluation of a run of this scenario. `truth` must outlive the result.
score::RunReferences run_references(const Scenario& scenario, const ScenarioFiles& files, const TrueMap& truth);

/// Stations, given goals and dock of a mission, with which the arrivals that the robot reports are compared.
std::vector<score::MissionGoal> mission_goals(const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
