#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/temporary_folder.h"
#include "app/record/run_directory.h"
#include "app/run/progress_line.h"
#include "app/run/run_loop.h"
#include "io/logs/log_compare.h"

namespace patrol::app {
ExitCode verify_command(const std::filesystem::path& run) {
  const RunDirectory directory = open_run_directory(run);
  const Scenario scenario = load_scenario(directory.scenario());
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(directory.scenario()));

  const TemporaryFolder again("verify");
  const std::filesystem::path log = again.path() / "log.mcap";
  fmt::print(stderr, "verify: rerunning {}, seed {}\n", directory.scenario().string(), scenario.seed);
  sim::Simulator simulator = make_simulator(scenario, files);
  stack::Stack stack = make_stack(scenario, files);
  ProgressLine observer("verify", scenario.time_limit_s);
  if (run_loop(scenario, files, simulator, stack, log, observer).end == RunEnd::kInterrupted)
    throw std::runtime_error("interrupted; nothing compared");

  const std::optional<io::LogDifference> difference = io::first_difference(directory.log(), log);
  if (!difference) {
    fmt::print("reproduced: {} is byte-identical\n", directory.log().string());
    return ExitCode::kDone;
  }
  fmt::print("differs: {}\n", io::describe(*difference));
  return ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
