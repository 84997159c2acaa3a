#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/common/output_directory.h"
#include "app/run/run_verdict.h"
#include "app/scoring/relation_table.h"
#include "app/scoring/score_json.h"
#include "app/scoring/score_run.h"
#include "app/scoring/score_table.h"
#include "core/error.h"
#include "io/maps/map_server.h"
#include "io/trajectories/relations.h"
#include "io/trajectories/tum.h"

namespace patrol::app {
namespace {

ExitCode score_directory(const std::filesystem::path& root) {
  const RunDirectory directory = open_run_directory(root);
  if (std::filesystem::exists(incomplete_marker(directory.root))) {
    throw InputError(fmt::format("{}: incomplete run; cannot be scored", directory.root.string()));
  }
  const Scenario scenario = load_scenario(directory.scenario());
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(directory.scenario()));
  const ScoredRun scored = score_run(directory.log(), scenario, files);
  save_scored_run(directory, scored, scenario);
  io::Metrics metrics = to_json(scored.score);
  if (std::filesystem::exists(directory.metrics())) {
    const io::Metrics before = io::load_metrics(directory.metrics());
    if (before.contains("performance")) metrics["performance"] = before["performance"];
  }
  io::save_metrics(directory.metrics(), metrics);
  const std::vector<CheckedExpectation> checks = check_expectations(scenario.expect, metrics);
  fmt::print("{}", score_table(metrics, checks));
  // The log does not contain how the run ended: only the expectations count.
  return exit_code_of(status_of(RunEnd::kMissionOver, checks));
}

}  // namespace

ExitCode score_command(const ScoreOptions& options) {
  const bool is_pair_of_trajectories = !options.estimate.empty() && !options.reference.empty();
  const bool is_relations = !options.estimate.empty() && !options.relations.empty();
  const bool is_pair_of_maps = !options.map.empty() && !options.reference_map.empty();
  if (!options.run.empty()) return score_directory(options.run);
  if (is_relations) {
    const Trajectory estimate = io::load_tum(options.estimate, io::SameStamps::kKeepFirst);
    fmt::print("{}", relation_table(score::relation_error(estimate, io::load_relations(options.relations),
                                                          options.relation_settings)));
    return ExitCode::kDone;
  }
  if (is_pair_of_trajectories) {
    fmt::print("{}",
               score_table(score_trajectories(io::load_tum(options.estimate), io::load_tum(options.reference)), {}));
    return ExitCode::kDone;
  }
  if (is_pair_of_maps) {
    fmt::print("{}", score_table(score_maps(io::load_map(options.map), io::load_map(options.reference_map)), {}));
    return ExitCode::kDone;
  }
  throw InputError(
      "score: needs a run directory, or --estimate and --reference, or --estimate and --relations, or --map and "
      "--reference-map");
}

}  // namespace patrol::app
