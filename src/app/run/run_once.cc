#include "app/run/run_once.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <mujoco/mujoco.h>
#include <nlohmann/json.hpp>

#include "app/common/output_directory.h"
#include "app/common/process_cost.h"
#include "app/common/temporary_folder.h"
#include "app/record/run_directory.h"
#include "app/run/make_simulator.h"
#include "app/run/make_stack_port.h"
#include "app/run/route_extent.h"
#include "app/run/run_junit.h"
#include "app/run/snapshot.h"
#include "app/scenario/data_folders.h"
#include "app/scoring/score_json.h"
#include "app/scoring/score_run.h"
#include "core/error.h"
#include "core/state/state_archive.h"
#include "io/json/metrics_json.h"
#include "io/logs/run_log.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::app {
namespace {

/// Header comment of a resolved scenario.
std::string origin_comment(const std::string& name) {
  return fmt::format("{}, all settings with defaults, patrol {}, MuJoCo {}", name, PATROL_VERSION, mj_versionString());
}

io::Metrics performance_of(const RunOutcome& outcome) {
  io::Metrics performance;
  performance["real_time_factor"] = to_seconds(outcome.duration - outcome.start) / outcome.wall_s;
  performance["wall_s"] = outcome.wall_s;
  performance["cpu_s"] = outcome.cpu_s;
  performance["peak_memory_mb"] = peak_memory_mb();
  for (const auto& [part, seconds] : outcome.seconds_by_stage) performance["parts_s"][part] = seconds;
  for (const auto& [part, calls] : outcome.calls_by_stage) performance["parts_calls"][part] = calls;
  return performance;
}

/// Simulator and stack of a scenario. A stack in another process starts while the simulator is built.
struct RunSystem {
  RunSystem(const Scenario& scenario, const StackContext& context)
      : RunSystem(scenario, load_scenario_files(scenario, context.data_root), context) {}
  RunSystem(const Scenario& scenario, ScenarioFiles scenario_files, const StackContext& context)
      : files(std::move(scenario_files)),
        stack(make_stack_port(scenario, files, context)),
        simulator(make_simulator(scenario, files, context.has_thread)) {
    require_stations_near(files.route, simulator.physics());
    check_kidnaps(scenario, files);
  }

  ScenarioFiles files;
  std::unique_ptr<StackPort> stack;
  sim::Simulator simulator;
};

/// Throws InputError if the state of a stack cannot be saved.
void check_state(StackPort& stack) {
  StateArchive trial;
  stack.serialize_state(trial);
}

/// Throws InputError if a period of snapshots is shorter than a tick.
void check_snapshot_period(double period_s, Time tick) {
  if (period_s > 0.0 && from_seconds(period_s) < tick) {
    throw InputError(
        fmt::format("--snapshot-every {:g}: must be at least {:g} s, one tick", period_s, to_seconds(tick)));
  }
}

/// Beginning of a branch: the other run up to an instant.
class Branch {
 public:
  /// Throws InputError if the run cannot be continued with the scenario.
  Branch(BranchOrigin origin, const Scenario& scenario, const StackContext& context, Time tick,
         const std::filesystem::path& root)
      : origin_(std::move(origin)), parent_(open_run_directory(origin_.run)), context_(context) {
    if (!parent_.is_complete()) throw InputError(origin_.run.string() + ": the run is incomplete");
    if (std::filesystem::exists(root) && std::filesystem::equivalent(root, origin_.run))
      throw InputError(origin_.run.string() + ": a branch needs another --out directory");
    scenario_ = load_scenario(parent_.scenario());
    origin_.at = (origin_.at + tick - Time{1}) / tick * tick;
    is_changed_ = to_yaml(scenario_) != to_yaml(scenario);
    const std::optional<Time> end = io::McapReader(parent_.log()).last_time();
    if (!end || origin_.at > *end)
      throw InputError(fmt::format("{}: the run ends before {:.3f} s", origin_.run.string(), to_seconds(origin_.at)));
    check_branch_settings(scenario_, scenario, origin_.at);
    snapshot_ = load_snapshot(parent_.snapshots(), origin_.at, content_hash(scenario_, context_.data_root));
    if (!snapshot_ && std::filesystem::exists(parent_.branch())) {
      throw InputError(
          fmt::format("{}: is a branch without a snapshot at or before {:.3f} s: repeat it with "
                      "--snapshot-every",
                      origin_.run.string(), to_seconds(origin_.at)));
    }
  }

  /// Writes the file that names the other run.
  void save_origin(const std::filesystem::path& file) const {
    io::Metrics origin;
    origin["branch_of"] = std::filesystem::absolute(origin_.run).lexically_normal().string();
    origin["at_s"] = to_seconds(origin_.at);
    origin["has_other_settings"] = is_changed_;
    io::save_metrics(file, origin);
  }

  /// Writes the messages up to the instant and returns the state there; none if the observer stops the run.
  std::optional<std::string> begin(io::RunLogWriter& log, RunObserver& observer) {
    if (snapshot_) copy_log(log);
    if (snapshot_ && (snapshot_->time == origin_.at || !is_changed_)) return std::move(snapshot_->bytes);
    RunSystem run(scenario_, context_);
    RunPart part;
    if (snapshot_) part.start = std::move(snapshot_->bytes);
    std::string state = run_until(origin_.at, scenario_, run.simulator, *run.stack, log, observer, part);
    return state.empty() ? std::nullopt : std::optional(std::move(state));
  }

 private:
  void copy_log(io::RunLogWriter& log) const {
    io::McapReader reader(parent_.log(), {.topics = {}, .to = snapshot_->time - Time{1}});
    while (const std::optional<io::McapMessage> message = reader.next()) log.copy(*message);
  }

  BranchOrigin origin_;
  RunDirectory parent_;
  StackContext context_;
  Scenario scenario_;
  bool is_changed_ = false;
  std::optional<RunState> snapshot_;
};

/// Origin of a branch, by its file. Throws InputError if the other run is missing.
BranchOrigin load_origin(const std::filesystem::path& file) {
  BranchOrigin origin;
  try {
    const io::Metrics json = io::load_metrics(file);
    origin = {.run = json.at("branch_of").get<std::string>(), .at = from_seconds(json.at("at_s").get<double>())};
  } catch (const nlohmann::json::exception&) {
    throw InputError(file.string() + ": must have the text branch_of and the number at_s");
  }
  if (!std::filesystem::exists(RunDirectory{origin.run}.log())) {
    throw InputError(fmt::format("{}: branch_of = {}: run not found: a branch is repeated from its run", file.string(),
                                 origin.run.string()));
  }
  return origin;
}

/// Traced part of a run, both ends included.
struct TraceSpan {
  Time from{}, to{};
};

/// Repeats a run up to the end of a span, reports the hashes of its ticks, and returns the state at the end; empty if
/// the run ends before. A branch without a snapshot begins with the run that it continues. `messages`: hash of the
/// messages that were traced before.
std::string trace_part(const RunDirectory& directory, const TraceSpan& span, const std::filesystem::path& folder,
                       std::uint64_t messages, const std::function<void(const TickDigest&)>& on_tick) {
  const std::filesystem::path data_root = find_data_root(directory.scenario());
  const Scenario scenario = load_scenario(directory.scenario());
  refuse_other_process(scenario, directory.root.string());
  RunPart part;
  part.trace = on_tick;
  part.trace_from = span.from;
  if (auto snapshot = load_snapshot(directory.snapshots(), span.from, content_hash(scenario, data_root))) {
    part.start = std::move(snapshot->bytes);
  } else if (std::filesystem::exists(directory.branch())) {
    const BranchOrigin origin = load_origin(directory.branch());
    const RunDirectory parent = open_run_directory(origin.run);
    if (span.to < origin.at) return trace_part(parent, span, folder, messages, on_tick);
    const auto trace_parent = [&](const TickDigest& tick) {
      messages = tick.messages;
      if (tick.time < origin.at) on_tick(tick);
    };
    part.start = trace_part(parent, {std::min(span.from, origin.at), origin.at}, folder, messages, trace_parent);
    if (part.start.empty())
      throw InputError(fmt::format("{}: branch_of = {}: the run ends before {:.3f} s", directory.branch().string(),
                                   origin.run.string(), to_seconds(origin.at)));
  }
  part.traced_messages = messages;
  RunSystem run(scenario,
                {.scenario = "trace", .data_root = data_root, .output = folder / "stack.log", .is_interrupted = [] {
                   return false;
                 }});
  check_state(*run.stack);
  NullObserver observer;
  io::RunLogWriter log(folder / "log.mcap", run.files.robot);
  return run_until(span.to, scenario, run.simulator, *run.stack, log, observer, part);
}

}  // namespace

void refuse_other_process(const Scenario& scenario, const std::string& location) {
  if (!scenario.stack.command.empty()) {
    throw InputError(fmt::format("{}: the state of a stack in another process cannot be saved (stack.command = {})",
                                 location, scenario.stack.command));
  }
}

RunVerdict complete_run(const RunDirectory& directory, const Scenario& scenario, const std::string& name,
                        const ScenarioFiles& files, const RunOutcome& outcome) {
  const ScoredRun scored = score_run(directory.log(), scenario, files);
  save_scored_run(directory, scored, scenario);
  io::Metrics metrics = metrics_of(scored);
  metrics["performance"] = performance_of(outcome);
  io::save_metrics(directory.metrics(), metrics);
  RunVerdict verdict = verdict_of(outcome, scenario.kidnaps, metrics, check_expectations(scenario.expect, metrics));
  io::save_junit(directory.junit(), {junit_suite(name, junit_properties(scenario), verdict)});
  complete_output(directory.root);
  return verdict;
}

BranchOrigin parse_branch(const std::string& text) {
  constexpr double kMaxBranch_s = 1e9;
  const std::size_t at = text.rfind('@');
  double seconds = 0.0;
  std::istringstream number(at == std::string::npos ? "" : text.substr(at + 1));
  if (!(number >> seconds) || !number.eof() || !(seconds > 0.0 && seconds <= kMaxBranch_s))
    throw InputError(fmt::format("--from {}: must be RUN@SECONDS, for example out/run@63.2", text));
  return {.run = text.substr(0, at), .at = from_seconds(seconds)};
}

void trace_run(const std::filesystem::path& root, Time from, Time to,
               const std::function<void(const TickDigest&)>& on_tick) {
  const TemporaryFolder folder("trace");
  trace_part(open_run_directory(root), {from, to}, folder.path(), 0, on_tick);
}

std::vector<Time> trace_starts(const RunDirectory& directory) {
  std::vector<Time> starts = {Time{}};
  if (std::filesystem::exists(directory.branch())) {
    const BranchOrigin origin = load_origin(directory.branch());
    starts = trace_starts(open_run_directory(origin.run));
    std::erase_if(starts, [&](Time time) { return time > origin.at; });
  }
  std::ranges::copy(snapshot_times(directory.snapshots()), std::back_inserter(starts));
  std::ranges::sort(starts);
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  return starts;
}

std::optional<RunVerdict> run_once(const Scenario& scenario, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer, const RunMode& mode) {
  return run_once(scenario, load_scenario_files(scenario, data_root), name, data_root, root, observer, mode);
}

std::optional<RunVerdict> run_once(const Scenario& scenario, const ScenarioFiles& files, const std::string& name,
                                   const std::filesystem::path& data_root, const std::filesystem::path& root,
                                   RunObserver& observer, const RunMode& mode) {
  const StackContext context{.scenario = name,
                             .data_root = data_root,
                             .output = RunDirectory{root}.stack_output(),
                             .is_interrupted = [&] { return observer.is_interrupted(); },
                             .has_thread = mode.num_threads > 1};
  if (mode.has_snapshots() || mode.branch) refuse_other_process(scenario, mode.branch ? "--from" : "--snapshot-every");
  RunSystem run(scenario, files, context);  // these throw InputError before anything is written
  check_snapshot_period(mode.snapshot_period_s, run.simulator.tick());
  if (mode.has_snapshots() || mode.branch) check_state(*run.stack);
  std::optional<Branch> branch;
  if (mode.branch) branch.emplace(*mode.branch, scenario, context, run.simulator.tick(), root);
  const std::string content = mode.has_snapshots() ? content_hash(scenario, data_root) : "";

  const RunDirectory directory = begin_run_directory(root);
  io::save_junit(directory.junit(), {unfinished_suite(name, junit_properties(scenario))});
  save_scenario(directory.scenario(), scenario, origin_comment(name));
  if (branch) branch->save_origin(directory.branch());

  observer.begin(run.files);
  io::RunLogWriter log(directory.log(), run.files.robot);
  RunPart part;
  if (branch) {
    const std::optional<std::string> state = branch->begin(log, observer);
    if (!state) return std::nullopt;
    part.start = *state;
  }
  const SnapshotFolder snapshots(directory.snapshots(), content, name);
  if (mode.has_snapshots()) {
    part.snapshot_period = from_seconds(mode.snapshot_period_s);
    part.snapshot_times = mode.snapshot_times;
    part.save = [&](Time now, std::string state) { snapshots.save({.time = now, .bytes = std::move(state)}); };
  }
  const RunOutcome outcome = run_to_end(scenario, run.simulator, *run.stack, log, observer, part);
  run.stack.reset();  // ends a stack in another process
  observer.end_simulation();
  if (outcome.end == RunEnd::kInterrupted || observer.is_interrupted()) return std::nullopt;

  return complete_run(directory, scenario, name, run.files, outcome);
}

}  // namespace patrol::app
