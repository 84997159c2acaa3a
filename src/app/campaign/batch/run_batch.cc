#include "app/campaign/batch/run_batch.h"

#include <csignal>
#include <cstring>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/campaign/batch/work_folder.h"
#include "app/common/progress_bar.h"
#include "app/run/run_once.h"
#include "app/scenario/data_folders.h"
#include "core/error.h"

namespace patrol::app {
namespace {

RunVerdict verdict_of_run(const BatchRun& run, const std::filesystem::path& work) {
  try {
    const Scenario scenario = load_scenario(run.scenario, run.overrides);
    NullObserver observer;
    return run_once(scenario, run.scenario.stem().string(), find_data_root(run.scenario), work, observer).value();
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

class Batch {
 public:
  Batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root)
      : runs_(runs), settings_(settings), work_(root), store_(runs_folder(root)) {
    for (std::size_t i = 0; i < runs.size(); ++i) pending_.push_back(i);
  }

  bool run() {
    while (!pending_.empty()) {
      const std::vector<std::size_t> iteration = std::exchange(pending_, {});
      const bool is_through = run_in_processes(
          iteration.size(), settings_.pool, [&](std::size_t i) { return run_child(runs_[iteration[i]]); },
          [&](const TaskEnd& end) { handle(iteration[end.task], end); },
          [&] {
            show();
            return !interrupt_.is_interrupted();
          });
      if (!is_through) return false;
    }
    return true;
  }

 private:
  /// Executes a run in the child process.
  int run_child(const BatchRun& run) const {
    const std::filesystem::path work = work_.path(run.key);
    RunVerdict verdict = verdict_of_run(run, work);
    std::string& message = verdict.message;  // must not depend on the work folder
    for (std::size_t at = 0; (at = message.find(work.string())) != std::string::npos;)
      message.replace(at, work.string().size(), "RUN");
    keep_or_remove(run.key, verdict.code());
    store_.save(run.key, verdict);
    return static_cast<int>(verdict.code());
  }

  void handle(std::size_t i, const TaskEnd& end) {
    const BatchRun& run = runs_[i];
    const bool is_killed_from_outside = end.signal == SIGKILL && !end.is_over_time;
    if (is_killed_from_outside && killed_once_.insert(i).second) {
      pending_.push_back(i);
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
  std::vector<std::size_t> pending_;
  std::set<std::size_t> killed_once_;
  std::size_t num_done_ = 0, num_failed_ = 0;
  ProgressBar bar_;
  InterruptGuard interrupt_;
};

}  // namespace

bool run_batch(const std::vector<BatchRun>& runs, const BatchSettings& settings, const std::filesystem::path& root) {
  return Batch(runs, settings, root).run();
}

}  // namespace patrol::app
