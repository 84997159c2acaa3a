#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "core/time.h"
#include "app/scenario.h"

namespace patrol::app {

enum class RunEnd { kMissionOver, kFall, kTimeLimit, kInterrupted };

/// How a run went, beyond what its log holds.
struct RunOutcome {
  RunEnd end = RunEnd::kMissionOver;
  Time duration{};                          ///< simulated
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::map<std::string, double> seconds_by_part;
  /// Faults the scenario declares and whether they happened: "lidar silence at 10 s: executed".
  std::vector<std::pair<std::string, bool>> faults_executed;
};

/// Called about ten times a second of wall time with the simulated time; true to go on, false to stop.
using ProgressCallback = std::function<bool(Time now, double distance_m)>;

/// Runs twin and stack against each other until the mission is over, and writes everything to `log_mcap`.
RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, const std::filesystem::path& log_mcap,
                    const ProgressCallback& progress);

}  // namespace patrol::app
