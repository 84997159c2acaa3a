#pragma once

#include "app/run/run_record.h"
#include "app/scenario.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// What a round found of lining and water against what was there: the keys `lining` and `water` of `inspection`. Nothing where nothing was
/// inspected.
io::Metrics tunnel_metrics(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files, const Pose2& T_world_map);

}  // namespace patrol::app
