#include <sys/resource.h>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/commands.h"
#include "app/expectations.h"
#include "app/goal_table.h"
#include "app/progress_bar.h"
#include "app/run_directory.h"
#include "app/run_junit.h"
#include "app/run_loop.h"
#include "app/score_run.h"
#include "app/score_table.h"

namespace patrol::app {
namespace {

std::filesystem::path default_directory(const RunOptions& options, const Scenario& scenario) {
  return std::filesystem::path("out") /
         fmt::format("{}_{}_seed{}", scenario.world, options.scenario.stem().string(), scenario.seed);
}

Scenario scenario_of(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  return load_scenario(options.scenario, overrides);
}

/// What a resolved scenario says about its making.
std::string made_by(const std::string& name) {
  return fmt::format("{}, every default written out, by patrol {} with MuJoCo {}", name, PATROL_VERSION, mj_versionString());
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

io::Metrics performance_of(const RunOutcome& outcome) {
  io::Metrics performance;
  performance["real_time_factor"] = to_seconds(outcome.duration) / outcome.wall_s;
  performance["wall_s"] = outcome.wall_s;
  performance["cpu_s"] = outcome.cpu_s;
  performance["peak_memory_mb"] = peak_memory_mb();
  for (const auto& [part, seconds] : outcome.seconds_by_part) performance["parts_s"][part] = seconds;
  return performance;
}

void print_faults(const std::vector<sim::FaultReport>& reports) {
  for (const sim::FaultReport& report : reports) {
    fmt::print("fault {}: {}\n", describe(report.fault), report.is_executed ? "executed" : "NOT EXECUTED");
  }
}

void print_kidnaps(std::size_t declared, std::size_t executed) {
  for (std::size_t i = 0; i < declared; ++i) fmt::print("kidnap {}: {}\n", i + 1, i < executed ? "executed" : "NOT EXECUTED");
}

/// The verdict of a run that came to its end.
ExitCode exit_code_of(RunEnd end, const std::vector<CheckedExpectation>& checks) {
  if (end == RunEnd::kTimeLimit) return ExitCode::kTimeLimit;
  return end == RunEnd::kFall || !all_met(checks) ? ExitCode::kExpectationMissed : ExitCode::kDone;
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
  const Scenario scenario = scenario_of(options);
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(options.scenario));
  const std::string name = options.scenario.stem().string();

  sim::Twin twin = make_twin(scenario, files);  // these refuse bad input before anything is written
  const std::unique_ptr<RobotStack> stack = make_stack(scenario, files);
  const RunDirectory directory = begin_run_directory(options.out.value_or(default_directory(options, scenario)));
  write_unfinished_junit(directory, scenario, name);
  save_scenario(directory.scenario(), scenario, made_by(name));

  ProgressBar bar;
  const InterruptGuard interrupt;
  const RunOutcome outcome =
      run_loop(scenario, files, twin, *stack, directory.log(), [&](Time now, double distance_m) {
        bar.show(fmt::format("{}  {:6.1f} s simulated  {:6.1f} m walked", name, to_seconds(now), distance_m));
        return !interrupt.is_interrupted();
      });
  if (outcome.end == RunEnd::kInterrupted) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", directory.root.string());
    return ExitCode::kProgramFailed;
  }

  io::Metrics metrics = score_run(directory, scenario, files);
  metrics["performance"] = performance_of(outcome);
  io::save_metrics(directory.metrics(), metrics);
  const std::vector<CheckedExpectation> checks = check_expectations(scenario.expect, metrics);
  const ExitCode code = exit_code_of(outcome.end, checks);
  write_junit(directory, scenario, name, outcome, checks);
  complete_run_directory(directory);

  fmt::print("{}\n", score_table(metrics, checks));
  if (const std::string goals = goal_table(metrics); !goals.empty()) fmt::print("{}\n", goals);
  print_faults(outcome.faults);
  print_kidnaps(scenario.kidnaps.size(), outcome.num_kidnaps);
  fmt::print("run directory: {}\n", directory.root.string());
  return code;
}

}  // namespace patrol::app
