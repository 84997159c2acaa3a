#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/run/run_directory.h"
#include "app/run/run_record.h"
#include "app/scenario.h"
#include "io/junit.h"
#include "io/metrics_json.h"

namespace patrol::app {

/// All that a run directory says. A run that was cut off has a log, and may lack everything else.
struct RunContents {
  RunDirectory directory;
  bool is_complete = false;
  std::string name;     ///< of the scenario
  std::string version;  ///< of the program that ran it
  std::string made_by;  ///< what the resolved scenario says about its making
  Scenario scenario;
  RunRecord record;
  io::Metrics metrics = io::Metrics::object();
  std::vector<io::JunitCase> cases;
  Pose2 T_world_map;
  std::optional<OccupancyGrid> truth_map;  ///< in world: what could be seen
  Grid<float> map_errors_m;                ///< of the map's occupied cells, as the score has it; empty when there is none

  double end_s() const { return to_seconds(record.T_world_body.back().stamp); }
};

/// Whether the truth, which begins with the run, has lasted until the estimate's first pose.
bool overlap(const Trajectory& estimate, const Trajectory& truth);

/// Throws InputError when it is no run directory, or what lies there cannot be read.
RunContents read_run_contents(const std::filesystem::path& root);

}  // namespace patrol::app
