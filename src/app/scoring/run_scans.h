#pragma once

#include <filesystem>
#include <vector>

#include "app/record/run_record.h"
#include "app/scenario/scenario.h"
#include "io/points/station_scans.h"

namespace patrol::app {

/// First panoramic scan of each station in a run's log, thinned and in map, as references for a later run. A registered
/// scan has its registered pose, the first one of a station the pose that the stack estimated.
std::vector<io::StationScan> station_scans(const std::filesystem::path& log_mcap, const RunRecord& record,
                                           const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
