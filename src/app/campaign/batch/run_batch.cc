#include "app/campaign/batch/run_batch.h"

#include <csignal>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/campaign/batch/shared_beginning.h"
#include "app/campaign/batch/work_folder.h"
#include "app/common/progress_bar.h"
#include "app/run/run_once.h"
#include "app/scenario/data_folders.h"
#include "app/scoring/expectations.h"
#include "core/error.h"
#include "io/files/output_error.h"
#include "io/mcap/mcap_reader.h"
#include "io/yaml/settings_yaml.h"
#include "link/socket.h"

namespace patrol::app {
namespace {

/// Shortest beginning that is worth a snapshot.
constexpr double kMinShared_s = 3.0;

/// Exit status of a child whose output cannot be written: EX_IOERR of sysexits.h.
constexpr int kCannotWrite = 74;

/// Throws OutputError or std::filesystem::filesystem_error if the output cannot be written, which is no result.
RunVerdict verdict_of_run(const BatchRun& run, const std::filesystem::path& work, const RunMode& mode) {
  try {
    const Scenario scenario = load_scenario(run.scenario, run.overrides);
    check_expected_metrics(scenario, {run.scenario.string(), run.overrides});
    NullObserver observer;
    return run_once(scenario, run.scenario.stem().string(), find_data_root(run.scenario), work, observer, mode).value();
  } catch (const io::OutputError&) {
    throw;
  } catch (const std::filesystem::filesystem_error&) {
    throw;
  } catch (const InputError& error) {
    return {.end = RunStatus::kWrongInput, .message = error.what(), .metrics = {}, .checks = {}, .events = {}};
  } catch (const std::exception& error) {
    return {.end = RunStatus::kFailed, .message = error.what(), .metrics = {}, .checks = {}, .events = {}};
  }
}

/// Verdict on a run whose process died without one.
RunVerdict verdict_of_crash(const TaskEnd& end, double timeout_s) {
  if (end.is_over_time) {
    return {.end = RunStatus::kWallTimeLimit,
            .message = fmt::format("after {:g} s", timeout_s),
            .metrics = {},
            .checks = {},
            .events = {}};
  }
  const std::string how = end.signal != 0 ? fmt::format("signal {} ({})", end.signal, ::strsignal(end.signal))
                                          : fmt::format("exit status {}", end.exit_code);
  return {.end = RunStatus::kCrashed,
          .message = end.last_stderr_line.empty() ? how : how + ": " + end.last_stderr_line,
          .metrics = {},
          .checks = {},
          .events = {}};
}

/// Whether a complete run has reached an instant.
bool has_reached(const std::filesystem::path& root, Time instant) {
  const RunDirectory run{root};
  if (!run.is_complete()) return false;
  const std::optional<Time> end = io::McapReader(run.log()).last_time();
  return end && *end >= instant;
}

/// Shared beginnings of the runs; none if a scenario is invalid, which its own run reports.
std::vector<std::optional<SharedBeginning>> beginnings_of(const std::vector<BatchRun>& runs) {
  std::vector<Scenario> scenarios;
  try {
    for (const BatchRun& run : runs) scenarios.push_back(load_scenario(run.scenario, run.overrides));
  } catch (const InputError&) {
    return std::vector<std::optional<SharedBeginning>>(runs.size());
  }
  return shared_beginnings(scenarios, kMinShared_s);
}

class Batch {
 public:
  Batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root)
      : runs_(runs), settings_(settings), work_(root), store_(runs_folder(root)) {
    beginnings_ = beginnings_of(runs);
    for (std::size_t i = 0; i < runs.size(); ++i) {
      (beginnings_[i] ? branches_ : pending_).push_back(i);
      if (beginnings_[i]) snapshot_times_[beginnings_[i]->leader].insert(beginnings_[i]->until);
    }
  }

  /// Makes the runs from which others branch first.
  bool run() {
    bool is_through = run_pending();
    if (is_through) {
      pending_ = std::exchange(branches_, {});
      is_through = run_pending();
    }
    if (!output_error_.empty())
      throw io::OutputError(output_error_ + "; runs are missing, repeat the command to continue");
    for (const auto& [leader, times] : snapshot_times_) {
      const std::string& key = runs_[leader].key;
      if (store_.has(key)) keep_or_remove(key, store_.load(key)->code());
    }
    return is_through;
  }

 private:
  bool run_pending() {
    while (!pending_.empty()) {
      const std::vector<std::size_t> iteration = std::exchange(pending_, {});
      const bool is_through = run_in_processes(
          iteration.size(), settings_.pool, [&](std::size_t i) { return run_child(iteration[i]); },
          [&](const TaskEnd& end) { handle(iteration[end.task], end); },
          [&] {
            show();
            return output_error_.empty() && !interrupt_.is_interrupted();
          });
      if (!is_through) return false;
    }
    return true;
  }

  /// Snapshots of a run from which others branch, or the origin of a branch. Without a complete origin, a run is made
  /// from its start.
  RunMode mode_of(std::size_t i) const {
    RunMode mode;
    if (const auto times = snapshot_times_.find(i); times != snapshot_times_.end())
      mode.snapshot_times.assign(times->second.begin(), times->second.end());
    if (beginnings_[i]) {
      const std::filesystem::path origin = work_.path(runs_[beginnings_[i]->leader].key);
      if (has_reached(origin, beginnings_[i]->until)) mode.branch = {.run = origin, .at = beginnings_[i]->until};
    }
    return mode;
  }

  /// Executes a run in the child process.
  int run_child(std::size_t i) const {
    try {
      return make_result(i);
    } catch (const io::OutputError& error) {
      fmt::print(stderr, "{}\n", error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
    return kCannotWrite;
  }

  int make_result(std::size_t i) const {
    const BatchRun& run = runs_[i];
    const std::filesystem::path work = work_.path(run.key);
    RunVerdict verdict = verdict_of_run(run, work, mode_of(i));
    std::string& message = verdict.message;  // must not depend on the work folder
    for (std::size_t at = 0; (at = message.find(work.string())) != std::string::npos;)
      message.replace(at, work.string().size(), "RUN");
    if (!snapshot_times_.contains(i)) keep_or_remove(run.key, verdict.code());
    store_.save(run.key, verdict);
    return static_cast<int>(verdict.code());
  }

  void handle(std::size_t i, const TaskEnd& end) {
    const BatchRun& run = runs_[i];
    // A job scheduler ends all processes of a job with SIGTERM or SIGKILL, in any order: here the run came first.
    const bool is_ended_from_outside = (end.signal == SIGKILL || end.signal == SIGTERM) && !end.is_over_time;
    if (is_ended_from_outside && (interrupt_.is_interrupted() || ended_once_.insert(i).second)) {
      pending_.push_back(i);
      return;
    }
    if (end.exit_code == kCannotWrite && !store_.has(run.key)) {
      output_error_ = end.last_stderr_line.empty() ? "the result cannot be written" : end.last_stderr_line;
      return;
    }
    if (!store_.has(run.key)) {
      store_.save(run.key, verdict_of_crash(end, settings_.pool.timeout_s));
      keep_or_remove(run.key, ExitCode::kProgramFailed);
    }
    const RunVerdict verdict = store_.load(run.key).value();
    ++num_done_;
    if (verdict.code() == ExitCode::kDone) return;
    ++num_failed_;
    bar_.print_line(fmt::format("{}: {}: {}", run.label, name_of(verdict.end), verdict.message));
  }

  void keep_or_remove(const std::string& key, ExitCode code) const {
    const bool is_kept =
        settings_.keep == KeepRuns::kAll || (settings_.keep == KeepRuns::kFailed && code != ExitCode::kDone);
    std::error_code ignored;
    if (is_kept) {
      std::filesystem::create_directories(store_.folder(), ignored);
      std::filesystem::remove_all(store_.folder() / key, ignored);
      std::filesystem::rename(work_.path(key), store_.folder() / key, ignored);
    }
    std::filesystem::remove_all(work_.path(key), ignored);
  }

  void show() {
    bar_.show(fmt::format("{} of {} runs, {} failed", num_done_, runs_.size(), num_failed_),
              static_cast<double>(num_done_) / static_cast<double>(runs_.size()));
  }

  const std::vector<BatchRun>& runs_;
  BatchSettings settings_;
  WorkFolder work_;
  ResultStore store_;
  std::vector<std::optional<SharedBeginning>> beginnings_;  ///< [run]
  std::map<std::size_t, std::set<Time>> snapshot_times_;    ///< [run from which others branch]
  std::vector<std::size_t> pending_;
  std::vector<std::size_t> branches_;  ///< runs after these
  std::set<std::size_t> ended_once_;   ///< runs whose process was ended from outside
  std::size_t num_done_ = 0, num_failed_ = 0;
  std::string output_error_;  ///< error of a run whose output cannot be written; empty: none
  ProgressBar bar_;
  InterruptGuard interrupt_;
};

}  // namespace

void require_own_stacks(const std::vector<BatchRun>& runs, const BatchSettings& settings) {
  if (settings.pool.num_processes < 2 || runs.size() < 2) return;
  std::set<std::pair<std::filesystem::path, std::vector<std::string>>> checked;  // runs but for their seeds
  for (const BatchRun& run : runs) {
    std::vector<std::string> overrides = run.overrides;
    std::erase_if(overrides, [](const std::string& one) { return one.starts_with("seed="); });
    if (!checked.emplace(run.scenario, std::move(overrides)).second) continue;
    std::string command;
    try {
      command = load_scenario(run.scenario, run.overrides).stack.command;
    } catch (const InputError&) {  // reported by its run
      continue;
    }
    if (link::is_address(command)) {
      throw InputError(
          fmt::format("--jobs {}: not possible with stack.command = {}: one run at a time can wait at an address: "
                      "must be --jobs 1, or a command that starts a stack for each run",
                      settings.pool.num_processes, command));
    }
  }
}

bool run_batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root) {
  return Batch(runs, settings, root).run();
}

}  // namespace patrol::app
