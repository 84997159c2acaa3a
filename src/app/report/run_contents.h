#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/scenario/scenario.h"
#include "io/files/junit.h"
#include "io/json/metrics_json.h"

namespace patrol::app {

/// Contents of a run directory. An interrupted run has a log, and may lack everything else.
struct RunContents {
  RunDirectory directory;
  bool is_complete = false;
  std::string name;            ///< name of the scenario
  std::string version;         ///< version of the program that ran it
  std::string origin_comment;  ///< first comment line of the resolved scenario
  Scenario scenario;
  RunRecord record;
  io::Metrics metrics = io::Metrics::object();
  std::vector<io::JunitCase> cases;
  Pose2 T_world_map;
  std::optional<OccupancyGrid> truth_map;  ///< in world: observable surfaces
  Grid<float> map_errors_m;                ///< errors of the map's occupied cells, as scored; empty without

  double end_s() const { return to_seconds(record.T_world_body.back().stamp); }
};

/// Whether the ground truth, which begins with the run, reaches the estimate's first pose.
bool overlap(const Trajectory& estimate, const Trajectory& truth);

/// Reads a run directory. Throws InputError if it is not one, or is not readable.
RunContents read_run_contents(const std::filesystem::path& root);

}  // namespace patrol::app
