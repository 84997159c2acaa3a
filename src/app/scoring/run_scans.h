#pragma once

#include <filesystem>
#include <vector>

#include "app/run/run_record.h"
#include "app/scenario.h"
#include "io/station_scans.h"

namespace patrol::app {

/// The first panoramic scan of each station in a run's log, thinned and in map: what a later round can take as references. Each lies where
/// its registration has put it, and a first one where the stack believed that it stood.
std::vector<io::StationScan> station_scans(const std::filesystem::path& log_mcap, const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files);

}  // namespace patrol::app
