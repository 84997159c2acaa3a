#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/scenario.h"
#include "core/time.h"
#include "stack/stack.h"

namespace patrol::app {

enum class RunEnd { kMissionOver, kFall, kTimeLimit, kInterrupted };

/// How a run went, beyond what its log holds.
struct RunOutcome {
  RunEnd end = RunEnd::kMissionOver;
  Time duration{};                                   ///< simulated
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::map<std::string, double> seconds_by_part;     ///< wall
  std::vector<sim::FaultReport> faults;
  std::size_t num_kidnaps = 0;                       ///< of those declared, in order, that were executed
};

/// Looks on while a run goes; nothing of it comes back into the run.
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  virtual void begin(const ScenarioFiles&) {}
  virtual void see(const stack::StackMessage&) {}
  virtual void see(const GroundTruth&) {}
  /// Twice a simulated second; false stops the run.
  virtual bool go_on(Time now, double distance_m) = 0;
};

/// Nobody looks on.
class Unobserved final : public RunObserver {
 public:
  bool go_on(Time, double) override { return true; }
};

/// Where the robot is put down, in world.
Pose2 start_in_world(const Scenario& scenario, const ScenarioFiles& files);

/// What lies about: the props named and those scattered.
std::vector<sim::PropSettings> props_of(const Scenario& scenario);

/// Throw InputError when what the scenario names does not go together.
sim::Twin make_twin(const Scenario& scenario, const ScenarioFiles& files);
stack::Stack make_stack(const Scenario& scenario, const ScenarioFiles& files);

/// Runs twin and stack against each other until the mission is over, and writes everything to `log_mcap`.
RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, sim::Twin& twin, stack::Stack& stack,
                    const std::filesystem::path& log_mcap, RunObserver& observer);

}  // namespace patrol::app
