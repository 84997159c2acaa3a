#include <unistd.h>

#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/common/progress_bar.h"
#include "app/report/run_summary.h"
#include "app/run/run_junit.h"
#include "app/run/run_verdict.h"
#include "app/scenario/data_folders.h"
#include "app/scoring/relation_table.h"
#include "app/scoring/score_json.h"
#include "app/scoring/score_run.h"
#include "app/scoring/score_table.h"
#include "core/error.h"
#include "io/json/registration_json.h"
#include "io/maps/map_server.h"
#include "io/trajectories/relations.h"
#include "io/trajectories/tum.h"

namespace patrol::app {
namespace {

ExitCode score_directory(const ScoreOptions& options) {
  const RunDirectory directory = open_run_directory(options.run);
  require_complete(directory, "cannot be scored");
  const Scenario scenario = load_scenario(directory.scenario());
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(directory.scenario()));
  const ScoredRun scored = [&] {
    ProgressBar bar;
    return score_run(directory.log(), scenario, files,
                     [&](const char* stage, double done) { bar.show(fmt::format("score  {}", stage), done); });
  }();
  const bool is_writable = ::access(directory.root.c_str(), W_OK) == 0;
  if (is_writable) save_scored_run(directory, scored, scenario);
  else fmt::print(stderr, "patrol: {}: cannot be written: the score is not saved\n", directory.root.string());
  io::Metrics metrics = metrics_of(scored);
  if (std::filesystem::exists(directory.metrics())) {
    const io::Metrics before = io::load_metrics(directory.metrics());
    if (before.contains("performance")) metrics["performance"] = before["performance"];
  }
  if (is_writable) io::save_metrics(directory.metrics(), metrics);
  const std::vector<CheckedExpectation> checks = check_expectations(scenario.expect, metrics);
  const std::optional<EarlyEnd> early = load_early_end(directory.junit());  // the log does not contain it
  const RunVerdict verdict{.end = early ? early->status : status_of(RunEnd::kMissionOver, checks),
                           .message = early ? early->message : "",
                           .metrics = std::move(metrics),
                           .checks = checks,
                           .events = {}};
  const std::string title = fmt::format("{}, seed {}", directory.root.string(), scenario.seed);
  print_result(options.form,
               options.show_all ? run_details(title, verdict, directory.root, output_style())
                                : run_summary(title, verdict, directory.root, output_style()),
               run_json(verdict, directory.root));
  return verdict.code();
}

/// Returns the first option of a file to score; empty if there is none.
std::string file_option_of(const ScoreOptions& options) {
  for (const auto& [name, file] :
       {std::pair{"--estimate", &options.estimate}, std::pair{"--reference", &options.reference},
        std::pair{"--relations", &options.relations}, std::pair{"--map", &options.map},
        std::pair{"--reference-map", &options.reference_map}}) {
    if (!file->empty()) return name;
  }
  return {};
}

/// Pose in the frame of the reference of the frame of a built map. In a run directory, the true map is in site, where
/// the registration places the map. Other maps are in one frame.
Pose2 map_in_reference(const std::filesystem::path& map, const std::filesystem::path& reference) {
  const RunDirectory run{map.parent_path()};
  const bool is_of_one_run =
      map.filename() == run.map().filename() && reference.lexically_normal() == run.truth_map().lexically_normal();
  if (!is_of_one_run || !std::filesystem::exists(run.registration())) return {};
  return io::load_registration(run.registration()).T_site_map;
}

/// Scores an estimate by a reference trajectory, by relations, or by both. Adds the metrics and their text.
void score_estimate_file(const ScoreOptions& options, io::Metrics& metrics, std::string& text) {
  std::size_t num_same_stamps = 0;
  const Trajectory estimate = io::load_tum(options.estimate, io::SameStamps::kKeepFirst, &num_same_stamps);
  if (!options.relations.empty()) {
    const score::RelationError error =
        score::relation_error(estimate, io::load_relations(options.relations), options.association.of_relations());
    metrics.update(relation_json(error));
    text += relation_table(error);
  }
  if (!options.reference.empty()) {
    const io::Metrics by_reference =
        score_trajectories(estimate, io::load_tum(options.reference), options.association.of_reference());
    metrics.update(by_reference);
    text += score_table(by_reference, {});
  }
  metrics["same_stamps"] = num_same_stamps;
  if (num_same_stamps > 0)
    text +=
        fmt::format("\n{} poses of the estimate left out: each has the stamp of the previous pose\n", num_same_stamps);
}

/// Throws InputError unless every option has the other one that it needs.
void check_pairs(const ScoreOptions& options) {
  const bool has_truth = !options.reference.empty() || !options.relations.empty();
  const bool has_estimate = !options.estimate.empty() && has_truth;
  const bool has_maps = !options.map.empty() && !options.reference_map.empty();
  if (!has_estimate && !has_maps) {
    throw InputError(
        "score: needs a run directory, or --estimate and --reference, or --estimate and --relations, or --map and "
        "--reference-map");
  }
  for (const auto& [option, is_alone, other] :
       {std::tuple{"--estimate", !options.estimate.empty() && !has_estimate, "--reference or --relations"},
        std::tuple{"--reference", !options.reference.empty() && !has_estimate, "--estimate"},
        std::tuple{"--relations", !options.relations.empty() && !has_estimate, "--estimate"},
        std::tuple{"--map", !options.map.empty() && !has_maps, "--reference-map"},
        std::tuple{"--reference-map", !options.reference_map.empty() && !has_maps, "--map"},
        std::tuple{"--max-dt-s", options.association.max_dt_s && !has_estimate, "--estimate"},
        std::tuple{"--reference-x-m", options.association.reference_x_m != 0.0 && options.relations.empty(),
                   "--relations"}}) {
    if (is_alone) throw InputError(fmt::format("{}: needs {}", option, other));
  }
}

}  // namespace

ExitCode score_command(const ScoreOptions& options) {
  validate(options.association.of_relations(), "relations");
  if (!options.run.empty()) {
    if (const std::string option = file_option_of(options); !option.empty())
      throw InputError(fmt::format("{}: excludes a run directory", option));
    if (options.association.is_given())
      throw InputError("--max-dt-s and --reference-x-m: exclude a run directory: its ground truth has every instant");
    return score_directory(options);
  }
  check_pairs(options);
  io::Metrics metrics;
  std::string text;
  if (!options.estimate.empty()) score_estimate_file(options, metrics, text);
  if (!options.map.empty()) {
    const io::Metrics by_map = score_maps(io::load_map(options.map), io::load_map(options.reference_map),
                                          map_in_reference(options.map, options.reference_map));
    metrics.update(by_map);
    text += score_table(by_map, {});
  }
  print_result(options.form, text, metrics);
  return ExitCode::kDone;
}

}  // namespace patrol::app
