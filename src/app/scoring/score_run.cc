#include "app/scoring/score_run.h"

#include "app/scoring/expectations.h"
#include "app/scoring/run_references.h"
#include "app/scoring/run_scans.h"
#include "app/scoring/score_json.h"
#include "core/error.h"

namespace patrol::app {

ScoredRun score_run(const std::filesystem::path& log_mcap, const Scenario& scenario, const ScenarioFiles& files,
                    const ScoreProgress& on_stage) {
  const auto show = [&](const char* stage, double done) {
    if (on_stage) on_stage(stage, done);
  };
  show("reading the log", 0.0);
  ScoredRun run{.record = read_run_record(log_mcap),
                .score = {},
                .truth = {},
                .scans = {},
                .has_built_in_stack = scenario.stack.command.empty()};
  run.score.mission = score::mission_score(run.record, mission_goals(scenario, files));
  if (scenario.course.optimal_time_s > 0.0 && !files.route.stations.empty()) {
    const Eigen::Vector2d p_world_goal = files.route.stations.back().T_route_body.position();  // site is world
    run.score.course =
        score::course_score(run.record, p_world_goal, scenario.course.arrival_m, scenario.course.optimal_time_s);
  }
  if (!run.record.has_estimate()) return run;
  show("station scans", 0.35);
  run.scans = station_scans(log_mcap, run.record, scenario, files);
  show("true map", 0.45);
  run.truth = true_map(run.record, scenario, files);
  show("metrics", 0.8);
  run.score.estimate = score::estimate_score(run.record, run_references(scenario, files, *run.truth));
  return run;
}

io::Metrics metrics_of(const ScoredRun& run) {
  io::Metrics metrics = to_json(run.score);
  add_published_topics(run.record, run.has_built_in_stack, metrics);
  return metrics;
}

io::Metrics score_trajectories(const Trajectory& estimate, const Trajectory& reference, Time max_dt) {
  const Pose2 T_reference_estimate = score::align_at_start(estimate, reference);
  const score::TrajectoryError error = score::trajectory_error(estimate, T_reference_estimate, reference);
  if (error.num_poses < 2)
    throw InputError("estimate: has one pose at the times of the reference: must be two or more");
  io::Metrics metrics;
  io::Metrics& pose = metrics["pose"];
  pose = to_json(error);
  pose["left_out"] = estimate.size() - error.num_poses;
  pose["coverage"] = score::time_coverage(estimate, reference);
  try {
    pose["aligned"] = to_json(score::aligned_error(estimate, reference, max_dt));
  } catch (const InputError& reason) {  // the errors in the frame of the start do not need an alignment
    pose["aligned"] = nullptr;
    pose["not_aligned"] = reason.what();
  }
  return metrics;
}

io::Metrics score_maps(const OccupancyGrid& built, const OccupancyGrid& reference, const Pose2& T_reference_built) {
  const score::ReferenceMap all_seeable{reference, Grid<std::uint8_t>(reference.geometry(), 1)};
  io::Metrics metrics;
  metrics["map"] = to_json(score::map_error(built, T_reference_built, all_seeable));
  return metrics;
}

}  // namespace patrol::app
