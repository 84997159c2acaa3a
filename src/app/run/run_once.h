#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/record/run_directory.h"
#include "app/run/run_loop.h"
#include "app/run/run_verdict.h"

namespace patrol::app {

/// Scores a run whose log is complete, and completes its directory. `name`: of the scenario.
RunVerdict complete_run(const RunDirectory& directory, const Scenario& scenario, const std::string& name,
                        const ScenarioFiles& files, const RunOutcome& outcome);

/// Start of a run from an instant of another run.
struct BranchOrigin {
  std::filesystem::path run;  ///< complete run directory
  Time at{};                  ///< instant from which the scenario of the branch applies, rounded up to a tick
};

/// Snapshots of a run, and its start.
struct RunMode {
  double snapshot_period_s = 0.0;         ///< 0: no periodic snapshots
  std::vector<Time> snapshot_times = {};  ///< instants of further snapshots, in ascending order
  std::optional<BranchOrigin> branch = {};
  int num_threads = 1;  ///< 2: expensive sensors and the built-in stack have threads of their own; same results

  bool has_snapshots() const { return snapshot_period_s > 0.0 || !snapshot_times.empty(); }
};

/// Returns the run directory and the instant of "RUN@SECONDS". Throws InputError.
BranchOrigin parse_branch(const std::string& text);

/// Throws InputError if the stack is in another process: its state cannot be saved. `location`: start of the message.
void refuse_other_process(const Scenario& scenario, const std::string& location);

/// Repeats a part of a run, from the newest snapshot before it, and reports the hashes of its ticks, both ends
/// included. Throws InputError if `root` is not a run of this program.
void trace_run(const std::filesystem::path& root, Time from, Time to,
               const std::function<void(const TickDigest&)>& on_tick);

/// Returns the start and the snapshots of a run, from which a trace can begin, in ascending order. A branch has those
/// of the run that it continues, too.
std::vector<Time> trace_starts(const RunDirectory& directory);

/// Runs a scenario, scores it, and writes a complete run directory at `root`. Returns none if `observer` stopped the
/// run: the directory stays marked incomplete. Throws InputError, before anything is written, if a file of the scenario
/// is missing or its settings are inconsistent. A branch begins with the messages of the other run up to the instant,
/// so that its log, score and report are those of a whole run.
std::optional<RunVerdict> run_once(const Scenario& scenario, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer, const RunMode& mode = {});

/// Same, with files that are loaded already, such as those of another world.
std::optional<RunVerdict> run_once(const Scenario& scenario, const ScenarioFiles& files, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer, const RunMode& mode = {});

}  // namespace patrol::app
