#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/run/stack_port.h"
#include "app/run/tick_digest.h"
#include "app/scenario/scenario.h"
#include "core/time.h"
#include "io/logs/run_log.h"
#include "link/link_error.h"

namespace patrol::app {

enum class RunEnd { kMissionOver, kFall, kTimeLimit, kInterrupted, kStackFailed, kStackSilent };

/// Outcome of a run beyond its log.
struct RunOutcome {
  RunEnd end = RunEnd::kMissionOver;
  std::string stack_failure;  ///< sentence for kStackFailed and kStackSilent
  Time duration{};            ///< simulated time from the start of the run to its end
  Time start{};               ///< instant from which this process ran it; zero unless it is a branch
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::map<std::string, double> seconds_by_stage;       ///< wall time by stage
  std::map<std::string, std::uint64_t> calls_by_stage;  ///< number of calls by stage
  std::vector<sim::FaultStatus> faults;
  std::size_t num_kidnaps = 0;  ///< number of declared kidnaps, in order, that were triggered
};

/// Observer of a running simulation. Must not influence the run; may stop it by returning false from `keep_running`.
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  virtual void begin(const ScenarioFiles&) {}
  virtual void on_message(const stack::StackMessage&) {}
  virtual void on_ground_truth(const GroundTruth&) {}
  /// Returns whether the user has interrupted the run. Polled while Patrol waits for a stack in another process.
  virtual bool is_interrupted() const { return false; }
  /// Called every 0.5 s of simulated time; false stops the run.
  virtual bool keep_running(Time now, double distance_m) = 0;
  /// Called after the last tick, before the run is scored.
  virtual void end_simulation() {}
};

/// Observer that ignores everything.
class NullObserver final : public RunObserver {
 public:
  bool keep_running(Time, double) override { return true; }
};

/// Writes a message of the stack to the log.
void write_published(io::RunLogWriter& log, Time now, const PublishedMessage& message);
/// Sets the end of a run whose stack failed.
void set_failure(RunOutcome& outcome, const link::LinkError& error);

/// Start, end and snapshots of a part of a run.
struct RunPart {
  std::string start;                                  ///< state by StateArchive; empty: start of the run
  Time snapshot_period{};                             ///< zero: no periodic snapshots
  std::vector<Time> snapshot_times = {};              ///< instants of further snapshots, in ascending order
  std::function<void(const TickDigest&)> trace = {};  ///< receives every tick from `trace_from` on
  Time trace_from{};
  std::uint64_t traced_messages = 0;                 ///< hash of the messages that a part before this one has traced
  std::function<void(Time, std::string)> save = {};  ///< receives the state of each snapshot
};

/// Runs a part of a run, writes its messages to `log`, and returns the state at `end`. Throws InputError if the run
/// ends before. Returns an empty state if the observer stops the run.
std::string run_until(Time end, const Scenario& scenario, sim::Simulator& simulator, StackPort& stack,
                      io::RunLogWriter& log, RunObserver& observer, const RunPart& part);

/// Runs the last part of a run and closes the log.
RunOutcome run_to_end(const Scenario& scenario, sim::Simulator& simulator, StackPort& stack, io::RunLogWriter& log,
                      RunObserver& observer, const RunPart& part);

/// Runs simulator and stack in a closed loop until the mission ends, and writes everything to `log_mcap`. The run also
/// ends when the stack fails.
RunOutcome run_loop(const Scenario& scenario, const ScenarioFiles& files, sim::Simulator& simulator, StackPort& stack,
                    const std::filesystem::path& log_mcap, RunObserver& observer);

}  // namespace patrol::app
