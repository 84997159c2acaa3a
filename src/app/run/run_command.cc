#include <fmt/format.h>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "app/run/run_once.h"
#include "app/scoring/goal_table.h"
#include "app/scoring/score_table.h"

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

}  // namespace

ExitCode run_command(const RunOptions& options) {
  const Scenario scenario = scenario_of(options);
  const std::string name = options.scenario.stem().string();
  const std::filesystem::path root = options.out.value_or(default_directory(options, scenario));

  ProgressBar bar;
  const InterruptGuard interrupt;
  const std::optional<RunVerdict> verdict =
      run_once(scenario, name, find_data_root(options.scenario), root, [&](Time now, double distance_m) {
        bar.show(fmt::format("{}  {:6.1f} s simulated  {:6.1f} m walked", name, to_seconds(now), distance_m));
        return !interrupt.is_interrupted();
      });
  if (!verdict) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", root.string());
    return ExitCode::kProgramFailed;
  }

  fmt::print("{}\n", score_table(verdict->metrics, verdict->checks));
  if (const std::string goals = goal_table(verdict->metrics); !goals.empty()) fmt::print("{}\n", goals);
  for (const DeclaredEvent& event : verdict->events) fmt::print("{}: {}\n", event.what, event.is_executed ? "executed" : "NOT EXECUTED");
  fmt::print("run directory: {}\n", root.string());
  return verdict->code;
}

}  // namespace patrol::app
