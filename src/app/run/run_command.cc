#include <memory>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/progress_bar.h"
#include "app/run/run_once.h"
#include "app/run/terminal_watch.h"
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

/// One line that tells how far the run is.
class ProgressLine final : public RunObserver {
 public:
  explicit ProgressLine(const std::string& name) : name_(name) {}

  bool go_on(Time now, double distance_m) override {
    bar_.show(fmt::format("{}  {:6.1f} s simulated  {:6.1f} m walked", name_, to_seconds(now), distance_m));
    return !interrupt_.is_interrupted();
  }

 private:
  std::string name_;
  ProgressBar bar_;
  InterruptGuard interrupt_;
};

std::unique_ptr<RunObserver> observer_of(const RunOptions& options, const std::string& name) {
  if (options.watch) return std::make_unique<TerminalWatch>(name);
  return std::make_unique<ProgressLine>(name);
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
  const Scenario scenario = scenario_of(options);
  const std::string name = options.scenario.stem().string();
  const std::filesystem::path root = options.out.value_or(default_directory(options, scenario));

  std::unique_ptr<RunObserver> observer = observer_of(options, name);
  const std::optional<RunVerdict> verdict = run_once(scenario, name, find_data_root(options.scenario), root, *observer);
  observer.reset();  // gives the screen back
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
