#include "app/run/run_once.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/common/output_directory.h"
#include "app/common/process_cost.h"
#include "app/record/run_directory.h"
#include "app/run/make_stack_port.h"
#include "app/run/run_junit.h"
#include "app/scoring/score_json.h"
#include "app/scoring/score_run.h"

namespace patrol::app {
namespace {

/// Header comment of a resolved scenario.
std::string origin_comment(const std::string& name) {
  return fmt::format("{}, all settings with defaults, patrol {}, MuJoCo {}", name, PATROL_VERSION, mj_versionString());
}

io::Metrics performance_of(const RunOutcome& outcome) {
  io::Metrics performance;
  performance["real_time_factor"] = to_seconds(outcome.duration) / outcome.wall_s;
  performance["wall_s"] = outcome.wall_s;
  performance["cpu_s"] = outcome.cpu_s;
  performance["peak_memory_mb"] = peak_memory_mb();
  for (const auto& [part, seconds] : outcome.seconds_by_stage) performance["parts_s"][part] = seconds;
  return performance;
}

}  // namespace

RunVerdict complete_run(const RunDirectory& directory, const Scenario& scenario, const std::string& name,
                        const ScenarioFiles& files, const RunOutcome& outcome) {
  const ScoredRun scored = score_run(directory.log(), scenario, files);
  save_scored_run(directory, scored, scenario);
  io::Metrics metrics = metrics_of(scored);
  metrics["performance"] = performance_of(outcome);
  io::save_metrics(directory.metrics(), metrics);
  RunVerdict verdict = verdict_of(outcome, scenario.kidnaps, metrics, check_expectations(scenario.expect, metrics));
  io::save_junit(directory.junit(), {junit_suite(name, junit_properties(scenario), verdict)});
  complete_output(directory.root);
  return verdict;
}

std::optional<RunVerdict> run_once(const Scenario& scenario, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer) {
  return run_once(scenario, load_scenario_files(scenario, data_root), name, data_root, root, observer);
}

std::optional<RunVerdict> run_once(const Scenario& scenario, const ScenarioFiles& files, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer) {
  sim::Simulator simulator = make_simulator(scenario, files);  // these throw InputError before anything is written
  const std::unique_ptr<StackPort> stack =
      make_stack_port(scenario, files,
                      {.scenario = name,
                       .data_root = data_root,
                       .tick = simulator.tick(),
                       .output = RunDirectory{root}.stack_output(),
                       .is_interrupted = [&] { return observer.is_interrupted(); }});
  const RunDirectory directory = begin_run_directory(root);
  io::save_junit(directory.junit(), {unfinished_suite(name, junit_properties(scenario))});
  save_scenario(directory.scenario(), scenario, origin_comment(name));

  const RunOutcome outcome = run_loop(scenario, files, simulator, *stack, directory.log(), observer);
  if (outcome.end == RunEnd::kInterrupted) return std::nullopt;

  return complete_run(directory, scenario, name, files, outcome);
}

}  // namespace patrol::app
