#pragma once

#include "app/run/run_record.h"
#include "app/scenario.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// Of a robot that drives a tour: `goals`, `docking` and `localization`, each only if the log has something of it.
io::Metrics tour_metrics(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files, const Pose2& T_world_map);

}  // namespace patrol::app
