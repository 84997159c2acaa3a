#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/campaign/batch/program.h"
#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/common/progress_bar.h"
#include "app/record/run_directory.h"
#include "app/run/run_once.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/text.h"
#include "io/json/metrics_json.h"
#include "io/logs/log_compare.h"
#include "io/mcap/mcap_reader.h"
#include "link/stack_process.h"

namespace patrol::app {
namespace {

/// Run and the program that made it.
struct TracedRun {
  std::filesystem::path root;
  std::string program;
  std::string name;  ///< name of the program in messages, with its option if there is one
};

/// Program of an option, or else this program. Throws InputError if it is not found.
TracedRun traced_run(const RunDirectory& run, const char* option, const std::optional<std::string>& given) {
  if (!given) {
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    return {.root = run.root, .program = self, .name = self};
  }
  if (!link::find_program(*given)) throw InputError(fmt::format("{} {}: program not found", option, *given));
  return {.root = run.root, .program = *given, .name = fmt::format("{} {}", option, *given)};
}

/// Lines of a trace. Throws InputError, which names the program, if a line is not that of a tick or if all are missing.
std::vector<TickDigest> parse_trace(const TracedRun& run, const std::string& output) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("{}: is not a patrol that can trace {}: {}", run.name, run.root.string(), reason));
  };
  std::vector<TickDigest> ticks;
  std::istringstream lines(output);
  try {
    for (std::string line; std::getline(lines, line);) ticks.push_back(parse_tick_digest(line));
  } catch (const InputError& error) {
    refuse(error.what());
  }
  if (ticks.empty()) refuse("it printed nothing");
  return ticks;
}

/// Traces a run from one instant to another by its own program: a line for each tick, at least one.
std::vector<TickDigest> trace(const TracedRun& run, Time from, Time to) {
  const ProgramResult result =
      run_program({run.program, "trace", run.root.string(), "--from-s", fmt::format("{}", to_seconds(from)), "--to-s",
                   fmt::format("{}", to_seconds(to))});
  if (result.exit_code != 0) throw InputError(fmt::format("{}: cannot be traced by {}", run.root.string(), run.name));
  return parse_trace(run, result.output);
}

/// Returns whether a run is a branch with settings of its own from an instant on.
bool has_changed_settings(const std::filesystem::path& root) {
  const std::filesystem::path branch = RunDirectory{root}.branch();
  return std::filesystem::exists(branch) && io::load_metrics(branch).value("has_other_settings", true);
}

/// Simulated time whose ticks are compared without a search for a later start or a hint on snapshots.
constexpr Time kShortSearch = std::chrono::seconds(1);

/// Compares the traces of two runs. Between different builds or scenarios the bytes of a state may differ without a
/// difference in their values; then only motion and messages are compared.
class TracePair {
 public:
  TracePair(TracedRun a, TracedRun b) : a_(std::move(a)), b_(std::move(b)) {
    const TickDigest first_a = trace(a_, Time{}, Time{}).at(0), first_b = trace(b_, Time{}, Time{}).at(0);
    has_states_ = first_a.simulator == first_b.simulator && first_a.stack == first_b.stack &&
                  !has_changed_settings(a_.root) && !has_changed_settings(b_.root);
  }

  /// Names of the parts that differ.
  std::vector<std::string> different_parts(const TickDigest& a, const TickDigest& b) const {
    std::vector<std::string> parts;
    if (a.motion != b.motion) parts.emplace_back("motion");
    if (a.messages != b.messages) parts.emplace_back("messages");
    if (has_states_ && a.simulator != b.simulator) parts.emplace_back("state of the simulator");
    if (has_states_ && a.stack != b.stack) parts.emplace_back("state of the stack");
    return parts;
  }

  bool are_equal_at(Time time) const {
    return different_parts(trace(a_, time, time).at(0), trace(b_, time, time).at(0)).empty();
  }

  /// Returns an instant in [start, end) at which the runs are equal. Hashing the state at every tick takes longer than
  /// repeating a run, so that instants shortly before `end` are tried first.
  Time late_start(Time start, Time end) const {
    constexpr int kGrowth = 4;
    for (Time window = kShortSearch; end - window > start; window *= kGrowth) {
      if (are_equal_at(end - window)) return end - window;
    }
    return start;
  }

  struct Difference {
    Time time{};
    std::vector<std::string> parts;
  };
  std::optional<Difference> first_difference(Time from, Time to) const {
    const std::vector<TickDigest> ticks_a = trace(a_, from, to), ticks_b = trace(b_, from, to);
    for (std::size_t i = 0; i < std::min(ticks_a.size(), ticks_b.size()); ++i) {
      std::vector<std::string> parts = different_parts(ticks_a[i], ticks_b[i]);
      if (!parts.empty()) return Difference{ticks_a[i].time, std::move(parts)};
    }
    return std::nullopt;
  }

 private:
  TracedRun a_, b_;
  bool has_states_ = false;
};

/// Instants from which both runs can be traced, up to `end` and the ends of both, in ascending order; the start is the
/// first.
std::vector<Time> common_instants(const RunDirectory& a, const RunDirectory& b, Time end) {
  const std::vector<Time> of_a = trace_starts(a), of_b = trace_starts(b);
  std::vector<Time> common;
  std::ranges::set_intersection(of_a, of_b, std::back_inserter(common));
  const Time last = std::min({end, io::last_message_time(a.log()), io::last_message_time(b.log())});
  std::erase_if(common, [&](Time time) { return time > last; });
  return common;
}

/// Returns the seconds of an instant as the nearest number: 3.03 for 3,030,000,000 ns.
double nearest_seconds(Time time) { return static_cast<double>(time.count()) / 1e9; }

}  // namespace

ExitCode trace_command(const TraceOptions& options) {
  const Time from = from_seconds(options.from_s), to = from_seconds(options.to_s);
  if (to < from)
    throw InputError(fmt::format("--to-s {:g}: must be at least --from-s, {:g}", options.to_s, options.from_s));
  if (const Time end = io::last_message_time(open_run_directory(options.run).log()); from > end) {
    throw InputError(
        fmt::format("--from-s {:g}: must be in [0, {:.3f}], the duration of the run", options.from_s, to_seconds(end)));
  }
  trace_run(options.run, from, to, [](const TickDigest& tick) { fmt::print("{}\n", to_text(tick)); });
  return ExitCode::kDone;
}

ExitCode bisect_command(const BisectOptions& options) {
  const RunDirectory a = open_run_directory(options.a), b = open_run_directory(options.b);
  const TracedRun traced_a = traced_run(a, "--program-a", options.program_a);
  const TracedRun traced_b = traced_run(b, "--program-b", options.program_b);
  for (const RunDirectory& run : {a, b}) require_complete(run, "cannot be compared");
  ProgressBar bar;
  bar.show("bisect  comparing the logs");
  const std::optional<io::LogDifference> in_logs = io::first_difference(a.log(), b.log());
  if (!in_logs) {
    print_result(options.form, "equal: no message differs\n", {{"equal", true}});
    return ExitCode::kDone;
  }
  for (const RunDirectory& run : {a, b}) refuse_other_process(load_scenario(run.scenario()), run.root.string());
  const std::vector<Time> instants = common_instants(a, b, in_logs->log_time);
  if (instants.size() == 1 && in_logs->log_time > kShortSearch) {
    bar.print_line(fmt::format(
        "bisect: the runs have no common snapshot before {:.3f} s and are repeated from the start; runs with "
        "--snapshot-every are compared faster",
        to_seconds(in_logs->log_time)));
  }
  bar.show("bisect  comparing the starts");
  const TracePair pair(traced_a, traced_b);
  const auto last_equal = std::prev(std::partition_point(instants.begin() + 1, instants.end(), [&](Time time) {
    bar.show(fmt::format("bisect  comparing the states at {:.1f} s", to_seconds(time)));
    return pair.are_equal_at(time);
  }));
  const auto next = std::next(last_equal);
  const Time end = next == instants.end() ? in_logs->log_time + Time{1} : *next;
  bar.show(fmt::format("bisect  comparing the states before {:.1f} s", to_seconds(end)));
  const Time start = pair.late_start(*last_equal, end);
  bar.show(fmt::format("bisect  repeating both runs from {:.1f} to {:.1f} s", to_seconds(start), to_seconds(end)));
  const std::optional<TracePair::Difference> difference = pair.first_difference(start, end);
  if (!difference)
    throw InputError(fmt::format("{} and {}: their programs do not repeat the difference of their logs: {}",
                                 a.root.string(), b.root.string(), io::describe(*in_logs)));
  io::Metrics json;
  json["equal"] = false;
  json["first_difference_s"] = nearest_seconds(difference->time);
  json["parts"] = difference->parts;
  json["first_message"] = io::describe(*in_logs);
  print_result(options.form,
               fmt::format("first difference at {:.3f} s: {}\nfirst message that differs: {}\n",
                           to_seconds(difference->time), join(difference->parts, ", "), io::describe(*in_logs)),
               json);
  return ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
