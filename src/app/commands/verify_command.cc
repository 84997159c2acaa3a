#include <deque>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/temporary_folder.h"
#include "app/record/run_directory.h"
#include "app/run/feed_loop.h"
#include "app/run/make_simulator.h"
#include "app/run/make_stack_port.h"
#include "app/run/progress_line.h"
#include "app/run/recorded_stack.h"
#include "app/run/run_loop.h"
#include "app/scenario/data_folders.h"
#include "core/error.h"
#include "io/json/metrics_json.h"
#include "io/logs/log_compare.h"
#include "link/socket.h"
#include "link/stack_process.h"

namespace patrol::app {
namespace {

/// Returns whether a scenario of a run directory was written by `patrol feed`.
bool is_of_feed(const std::filesystem::path& scenario) {
  std::ifstream stream(scenario);
  std::string line;
  std::getline(stream, line);
  return line.starts_with(std::string("# ") + kFedComment);
}

/// Throws InputError if the command or the address of a stack is invalid.
void check_stack(const std::string& command) {
  if (link::is_address(command)) link::parse_address(command);
  else if (!command.empty()) link::check_program(link::command_words(command).front());
}

void throw_if_ended_early(const RunOutcome& outcome) {
  if (outcome.end == RunEnd::kInterrupted) throw std::runtime_error("interrupted; nothing compared");
  if (!outcome.stack_failure.empty()) throw std::runtime_error(outcome.stack_failure);
}

/// Prints the last lines of the output of a stack that has failed. Its file is in a temporary folder.
void print_last_lines(const std::filesystem::path& output) {
  constexpr std::size_t kMaxLines = 20;
  std::ifstream stream(output);
  std::deque<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
    if (lines.size() > kMaxLines) lines.pop_front();
  }
  if (lines.empty()) return;
  fmt::print(stderr, "verify: end of the output of the stack:\n");
  for (const std::string& line : lines) fmt::print(stderr, "{}\n", line);
}

/// Prints the result of one half of the verification. Returns whether it is reproduced.
bool report(const char* half, const std::optional<io::LogDifference>& difference) {
  fmt::print("{}: {}\n", half, difference ? "differs: " + io::describe(*difference) : "byte-identical");
  return !difference;
}

/// Throws InputError if a complete run cannot be verified as a whole.
void check_run(const RunDirectory& directory, const std::vector<StackTurnRecord>& turns, bool is_external) {
  if (is_of_feed(directory.scenario())) {
    throw InputError(
        fmt::format("{}: was made by patrol feed, and the answers in it had no effect on the robot: verify the run "
                    "that was fed",
                    directory.root.string()));
  }
  if (!turns.empty() && !turns.back().is_last) {
    throw InputError(fmt::format("{}: its stack failed after its turn at {:.3f} s: only a complete run can be verified",
                                 directory.log().string(), to_seconds(turns.back().turn)));
  }
  if (std::filesystem::exists(directory.branch()) &&
      io::load_metrics(directory.branch()).value("has_other_settings", true)) {
    throw InputError(
        fmt::format("{}: is a branch with other settings: only a whole run of one scenario can be verified",
                    directory.root.string()));
  }
  if (is_external && turns.empty()) {
    throw InputError(
        fmt::format("{}: its stack failed before the end of its first turn: only a complete run can be "
                    "verified",
                    directory.log().string()));
  }
}

/// Repeats the two halves of a run: the simulator with the recorded answers of the stack, and the stack with the
/// recorded messages of the simulator.
class Verification {
 public:
  Verification(const RunDirectory& directory, Scenario scenario, std::vector<StackTurnRecord> turns)
      : directory_(directory),
        scenario_(std::move(scenario)),
        turns_(std::move(turns)),
        data_root_(find_data_root(directory.scenario())),
        files_(load_scenario_files(scenario_, data_root_)),
        simulator_(make_simulator(scenario_, files_)) {}

  /// Returns whether the simulator writes the same messages, and prints the first difference.
  bool simulator_is_same() {
    fmt::print(stderr, "verify: rerunning {}, seed {}\n", directory_.scenario().string(), scenario_.seed);
    RecordedStack recorded(directory_.log(), simulator_.tick(), !turns_.empty());
    ProgressLine observer("verify simulator", scenario_.time_limit_s);
    const std::filesystem::path log = again_.path() / "simulator.mcap";
    throw_if_ended_early(run_loop(scenario_, files_, simulator_, recorded, log, observer));
    return report("simulator", io::first_difference(directory_.log(), log));
  }

  /// Returns whether the stack gives the same answers, and prints the first difference. `command`: command or address
  /// of the stack; none: that of the scenario.
  bool stack_is_same(const std::optional<std::string>& command) {
    if (command) scenario_.stack.command = *command;
    ProgressLine observer("verify stack", scenario_.time_limit_s);
    const std::filesystem::path output = again_.path() / "stack.log", log = again_.path() / "stack.mcap";
    std::unique_ptr<StackPort> stack = make_stack_port(scenario_, files_,
                                                       {.scenario = directory_.root.filename().string(),
                                                        .data_root = data_root_,
                                                        .output = output,
                                                        .output_name = "above",
                                                        .is_interrupted = [&] { return observer.is_interrupted(); }});
    const RunOutcome outcome = feed_loop(directory_.log(), files_, simulator_.tick(), *stack, log, observer, turns_);
    const bool has_turns = !turns_.empty() && stack->records_turns();
    stack.reset();  // writes the rest of the output
    if (!outcome.stack_failure.empty()) print_last_lines(output);
    throw_if_ended_early(outcome);
    const auto is_answer = [&](const std::string& topic) {
      return io::is_stack_output(topic) || (has_turns && topic == io::kTopic<StackTurnRecord>);
    };
    return report("stack", io::first_difference(directory_.log(), log, is_answer));
  }

 private:
  const RunDirectory& directory_;
  Scenario scenario_;
  std::vector<StackTurnRecord> turns_;
  std::filesystem::path data_root_;
  ScenarioFiles files_;
  sim::Simulator simulator_;
  TemporaryFolder again_{"verify"};
};

}  // namespace

ExitCode verify_command(const VerifyOptions& options) {
  const RunDirectory directory = open_run_directory(options.run);
  require_complete(directory, "cannot be verified");
  if (options.stack) check_stack(*options.stack);
  std::vector<StackTurnRecord> turns = read_turn_records(directory.log());
  Scenario scenario = load_scenario(directory.scenario());
  const std::string command = scenario.stack.command;
  check_run(directory, turns, !command.empty());
  Verification verification(directory, std::move(scenario), std::move(turns));

  bool is_same = verification.simulator_is_same();
  if (!command.empty() && !options.stack) {
    fmt::print("stack: not verified: start it with --stack, in this run: {}\n", command);
  } else {
    is_same = verification.stack_is_same(options.stack) && is_same;
  }
  return is_same ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

}  // namespace patrol::app
