#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/monitor/reporter.h"
#include "app/report/run_summary.h"
#include "app/run/progress_line.h"
#include "app/run/run_once.h"
#include "app/run/terminal_view.h"

namespace patrol::app {
namespace {

std::filesystem::path default_directory(const RunOptions& options, const Scenario& scenario) {
  return std::filesystem::path("out") /
         fmt::format("{}_{}_seed{}", scenario.world, options.scenario.stem().string(), scenario.seed);
}

Scenario scenario_of(const RunOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  Scenario scenario = load_scenario(options.scenario, overrides);
  if (options.stack) scenario.stack.command = *options.stack;
  return scenario;
}

/// Group of observers; each may stop the run.
class ObserverGroup final : public RunObserver {
 public:
  explicit ObserverGroup(std::vector<RunObserver*> observers) : observers_(std::move(observers)) {}

  void begin(const ScenarioFiles& files) override {
    for (RunObserver* one : observers_) one->begin(files);
  }
  void on_message(const stack::StackMessage& message) override {
    for (RunObserver* one : observers_) one->on_message(message);
  }
  void on_ground_truth(const GroundTruth& truth) override {
    for (RunObserver* one : observers_) one->on_ground_truth(truth);
  }
  bool is_interrupted() const override {
    return std::ranges::any_of(observers_, [](const RunObserver* one) { return one->is_interrupted(); });
  }
  bool keep_running(Time now, double distance_m) override {
    bool keeps_running = true;
    for (RunObserver* one : observers_) keeps_running = one->keep_running(now, distance_m) && keeps_running;
    return keeps_running;
  }

 private:
  std::vector<RunObserver*> observers_;
};

std::unique_ptr<RunObserver> observer_of(const RunOptions& options, const Scenario& scenario, const std::string& name) {
  if (options.watch) return std::make_unique<TerminalView>(name);
  return std::make_unique<ProgressLine>(name, scenario.time_limit_s);
}

std::unique_ptr<Reporter> reporter_of(const RunOptions& options, const Scenario& scenario, const std::string& name,
                                      const std::filesystem::path& root) {
  if (!options.monitor_url) return nullptr;
  const ReportedRun run{.robot = options.robot_name.value_or(fmt::format("{}-{}", scenario.robot, scenario.seed)),
                        .run = new_run_name(name, scenario.seed),
                        .world = scenario.world,
                        .scenario = name};
  return std::make_unique<Reporter>(root, run, make_monitor_server(*options.monitor_url, options.monitor_token_file));
}

std::optional<RunVerdict> run_reported(const RunOptions& options, const Scenario& scenario, const std::string& name,
                                       const std::filesystem::path& root, Reporter* reporter, RunObserver& screen) {
  const std::filesystem::path data_root = find_data_root(options.scenario);
  if (reporter == nullptr) return run_once(scenario, name, data_root, root, screen);
  ObserverGroup observers({&screen, reporter});
  try {
    std::optional<RunVerdict> verdict = run_once(scenario, name, data_root, root, observers);
    if (!verdict) reporter->finish("interrupted", "interrupted by user");
    else
      reporter->finish(verdict->code() == ExitCode::kDone ? "finished" : "failed",
                       verdict->message.empty() ? std::string(name_of(verdict->end)) : verdict->message);
    return verdict;
  } catch (const std::exception& error) {
    reporter->finish("failed", error.what());
    throw;
  }
}

void report_delivery(const Reporter& reporter, const std::string& to, const std::filesystem::path& root) {
  if (reporter.num_rejected() > 0) {
    fmt::print(stderr, "patrol: {} rejected {} results, kept in {}\n", to, reporter.num_rejected(),
               (root / "outbox.refused.jsonl").string());
  }
  if (const std::size_t num_pending = reporter.num_pending(); num_pending > 0) {
    fmt::print(stderr,
               "patrol: {} results not delivered, kept in {} ({}); upload with: patrol upload {} --monitor-url {}\n",
               num_pending, (root / "outbox.jsonl").string(), reporter.last_error(), root.string(), to);
  } else {
    fmt::print(stderr, "patrol: {} received all {} results\n", to, reporter.num_results());
  }
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
  const Scenario scenario = scenario_of(options);
  const std::string name = options.scenario.stem().string();
  const std::filesystem::path root = options.out.value_or(default_directory(options, scenario));

  const std::unique_ptr<Reporter> reporter = reporter_of(options, scenario, name, root);
  std::unique_ptr<RunObserver> observer = observer_of(options, scenario, name);
  const std::optional<RunVerdict> verdict = run_reported(options, scenario, name, root, reporter.get(), *observer);
  observer.reset();  // restores the screen
  if (reporter) report_delivery(*reporter, *options.monitor_url, root);
  if (!verdict) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", root.string());
    return ExitCode::kProgramFailed;
  }

  const std::string title = fmt::format("{}/{}, seed {}", scenario.world, name, scenario.seed);
  print_result(options.form,
               options.show_all ? run_details(title, *verdict, root, output_style())
                                : run_summary(title, *verdict, root, output_style()),
               run_json(*verdict, root));
  return verdict->code();
}

}  // namespace patrol::app
