#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/record/run_record.h"
#include "app/scenario/scenario.h"
#include "app/scoring/true_map.h"
#include "core/grid.h"
#include "report/blocks.h"

namespace patrol::app {

/// Completed run of a scenario with its ground truth.
struct StudyRun {
  Scenario scenario;
  ScenarioFiles files;
  std::filesystem::path log;
  RunRecord record;
  TrueMap truth;
};

/// Runs `scenario`, a path below the data root; its files are written to `folder`. Throws InputError like run_once.
StudyRun run_for_study(const std::string& scenario, const std::vector<std::string>& overrides, std::uint64_t seed,
                       const std::filesystem::path& folder);

/// Map built from a run's log, colored by its errors, with estimated and true path.
report::MapBlock map_error_block(const OccupancyGrid& map, const Trajectory& T_map_body, const StudyRun& run);

}  // namespace patrol::app
