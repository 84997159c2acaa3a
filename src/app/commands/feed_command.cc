#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/record/run_directory.h"
#include "app/report/run_summary.h"
#include "app/run/feed_loop.h"
#include "app/run/make_stack_port.h"
#include "app/run/progress_line.h"
#include "app/run/run_junit.h"
#include "app/run/run_once.h"
#include "app/scenario/data_folders.h"
#include "core/error.h"
#include "io/mcap/mcap_reader.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

/// Feeds a stack with the log of a run.
ExitCode feed_run(const FeedOptions& options) {
  if (!options.relations.empty() || !options.reference.empty())
    throw InputError("--relations and --reference: only for a recorded log: a run has its own ground truth");
  if (options.association.is_given())
    throw InputError("--max-dt-s and --reference-x-m: only for a recorded log: a run has its own ground truth");
  if (options.as_recorded) throw InputError("--as-recorded: only for a recorded log: a run is always fed as recorded");
  for (const std::string& setting : options.overrides) {
    const bool is_stack = setting.starts_with("stack.") && !setting.starts_with("stack.command=");
    if (is_stack || setting.starts_with("seed=")) continue;
    throw InputError(
        fmt::format("--set {}: must be stack.… or seed, but not stack.command: the data are those of the run, "
                    "and --stack selects the stack",
                    setting));
  }
  const RunDirectory fed = open_run_directory(options.input);
  if (std::filesystem::exists(incomplete_marker(fed.root)))
    fmt::print(stderr, "patrol: {}: incomplete run: fed up to its last message\n", fed.root.string());
  else require_whole_log(fed, "cannot be fed");
  if (const std::optional<EarlyEnd> early = load_early_end(fed.junit()); early && fed.is_complete()) {
    fmt::print(stderr, "patrol: {}: the run ended early ({}: {}): fed up to its end\n", fed.root.string(),
               name_of(early->status), early->message);
  }
  Scenario scenario = load_scenario(fed.scenario(), options.overrides);
  scenario.stack.command = options.stack.value_or("");  // never starts a command that a run directory names
  const std::filesystem::path data_root = find_data_root(fed.scenario());
  const ScenarioFiles files = load_scenario_files(scenario, data_root);
  const Time tick = sim::tick_of(files.world_xml.string());
  const std::string name = options.input.filename().string();
  if (std::filesystem::exists(options.out) && std::filesystem::equivalent(options.out, options.input))
    throw InputError(fmt::format("--out = {}: must not be the directory of the run", options.out.string()));
  io::last_message_time(fed.log());  // throws before earlier output is removed

  ProgressLine observer("feed " + name, scenario.time_limit_s);
  std::unique_ptr<StackPort> stack = make_stack_port(scenario, files,
                                                     {.scenario = name,
                                                      .data_root = data_root,
                                                      .output = RunDirectory{options.out}.stack_output(),
                                                      .is_interrupted = [&] { return observer.is_interrupted(); }});
  const RunDirectory directory = begin_run_directory(options.out);
  io::save_junit(directory.junit(), {unfinished_suite(name, junit_properties(scenario))});
  save_scenario(directory.scenario(), scenario, kFedComment + fed.log().string());
  const RunOutcome outcome = feed_loop(fed.log(), files, tick, *stack, directory.log(), observer);
  stack.reset();  // ends a stack in another process
  observer.end_simulation();
  if (outcome.end == RunEnd::kInterrupted || observer.is_interrupted()) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", directory.root.string());
    return ExitCode::kProgramFailed;
  }
  const RunVerdict verdict = complete_run(directory, scenario, name, files, outcome);
  const std::string title = fmt::format("stack fed with {}", options.input.string());
  print_result(options.form,
               options.show_all ? run_details(title, verdict, directory.root, output_style())
                                : run_summary(title, verdict, directory.root, output_style()),
               run_json(verdict, directory.root));
  return verdict.code();
}

}  // namespace

ExitCode feed_command(const FeedOptions& options) {
  return std::filesystem::is_directory(options.input) ? feed_run(options) : feed_log_command(options);
}

}  // namespace patrol::app
