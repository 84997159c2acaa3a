#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/scenario/scenario.h"
#include "app/scoring/true_map.h"
#include "core/grid.h"
#include "core/trajectory.h"
#include "io/json/metrics_json.h"
#include "io/points/station_scans.h"
#include "score/pose/trajectory_error.h"
#include "score/run/run_score.h"

namespace patrol::app {

/// Score of a run, with the contents of the other files of its directory.
struct ScoredRun {
  RunRecord record;
  score::RunScore score;
  std::optional<TrueMap> truth;        ///< present with `score.estimate`
  std::vector<io::StationScan> scans;  ///< first panoramic scan of each station
  bool has_built_in_stack = true;      ///< false: with a stack in another process
};

/// Called at the start of each stage with its name and the fraction of the whole work that is usually done by then.
using ScoreProgress = std::function<void(const char* stage, double done)>;

/// Scores a run from its log alone, and writes nothing. A run that ended before the first estimate has only the
/// mission's score.
ScoredRun score_run(const std::filesystem::path& log_mcap, const Scenario& scenario, const ScenarioFiles& files,
                    const ScoreProgress& on_stage = {});

/// Content of metrics.json but `performance`: the score, and the topics that the stack published.
io::Metrics metrics_of(const ScoredRun& run);

/// Writes trajectories, maps, localizability, station scans, and the commands and goals of a teleoperated drive to the
/// run's directory. Writes nothing for a run without an estimate. The caller writes metrics.json, because `performance`
/// is not known here.
void save_scored_run(const RunDirectory& directory, const ScoredRun& run, const Scenario& scenario);

/// Scores any two trajectories at the stamps of the estimate: metrics `pose.*`, with `pose.coverage` as the fraction of
/// the reference's time that they concern, `pose.left_out` as the number of poses outside the reference's time or in
/// its holes, and `pose.aligned.*`. Without a unique alignment `pose.aligned` is null and `pose.not_aligned` is the
/// reason. `max_dt`: maximum difference of stamps of the pairs that are aligned. Throws InputError if fewer than two
/// poses of the estimate have a reference.
io::Metrics score_trajectories(const Trajectory& estimate, const Trajectory& reference,
                               Time max_dt = score::kMaxAlignedDt);

/// Scores any two maps: metrics `map.*`. `T_reference_built`: pose of the frame of the built map in that of the
/// reference.
io::Metrics score_maps(const OccupancyGrid& built, const OccupancyGrid& reference, const Pose2& T_reference_built = {});

}  // namespace patrol::app
