#pragma once

#include "app/run/run_directory.h"
#include "app/scenario.h"
#include "core/grid.h"
#include "core/trajectory.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// Scores a run from its log alone: writes trajectories and maps into its directory, and returns the metrics (README, "A run
/// directory") but for `performance`, which only the run itself knows. A run that ended before the stack had an estimate has no figures but the mission's.
io::Metrics score_run(const RunDirectory& directory, const Scenario& scenario, const ScenarioFiles& files);

/// Everyone's two trajectories: `pose.*` and `pose.aligned.*`.
io::Metrics score_trajectories(const Trajectory& estimate, const Trajectory& reference);

/// Everyone's two maps, which share a frame: `map.*`.
io::Metrics score_maps(const OccupancyGrid& built, const OccupancyGrid& reference);

}  // namespace patrol::app
