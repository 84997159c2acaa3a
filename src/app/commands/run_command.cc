#include <algorithm>
#include <fstream>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/monitor/reporter.h"
#include "app/record/run_directory.h"
#include "app/report/run_summary.h"
#include "app/run/progress_line.h"
#include "app/run/run_once.h"
#include "app/run/run_verdict.h"
#include "app/run/terminal_view.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/mounts.h"
#include "app/scoring/expectations.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/text.h"
#include "io/yaml/settings_yaml.h"
#include "sim/locomotion/swing_speed.h"

namespace patrol::app {
namespace {

/// Returns the world that a run with goals names instead of a scenario.
std::optional<std::string> named_world(const RunOptions& options) {
  return options.goals.empty() ? std::nullopt : world_of(options.scenario);
}

/// Returns the name in the comment at the head of a scenario of a run directory.
std::string name_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::size_t end = line.find(',');
  return line.starts_with("# ") && end != std::string::npos ? line.substr(2, end - 2)
                                                            : file.parent_path().filename().string();
}

/// Name of the run's scenario.
std::string name_of(const RunOptions& options) {
  if (!options.from.empty()) return name_in(RunDirectory{parse_branch(options.from).run}.scenario());
  return named_world(options) ? "goals" : options.scenario.stem().string();
}

std::filesystem::path default_directory(const RunOptions& options, const Scenario& scenario) {
  if (!options.from.empty()) {
    const BranchOrigin branch = parse_branch(options.from);
    return fmt::format("{}_at_{}s", branch.run.lexically_normal().string(), to_seconds(branch.at));
  }
  return std::filesystem::path("out") / fmt::format("{}_{}_seed{}", scenario.world, name_of(options), scenario.seed);
}

/// Returns the tour of the goals on the command line; `scenario` gives the start unless an option does.
TourSettings tour_of(const RunOptions& options, const Scenario* scenario, const std::filesystem::path& data_root) {
  TourSettings tour;
  if (!options.start.empty()) {
    tour.start = parse_pose(options.start, "--start", {});
  } else if (scenario != nullptr) {
    const Pose2 start = load_start(*scenario, data_root);
    tour.start = {.x_m = start.x, .y_m = start.y, .heading_deg = to_deg(start.yaw)};
  } else {
    throw InputError("--goal: a run in a world needs --start X,Y[,DEG]");
  }
  PlanarPoseSettings from = tour.start;
  for (const std::string& goal : options.goals) {
    from = parse_pose(goal, "--goal", from);
    tour.stations.push_back({.name = fmt::format("goal_{}", tour.stations.size() + 1),
                             .x_m = from.x_m,
                             .y_m = from.y_m,
                             .heading_deg = from.heading_deg});
  }
  return tour;
}

/// Removes the expectations of the mission that the goals replace, and names them.
void drop_expectations_of_mission(const RunOptions& options, Scenario& scenario) {
  const std::vector<std::string> dropped = drop_mission_expectations(options.overrides, scenario.expect);
  if (dropped.empty()) return;
  fmt::print(stderr, "patrol: --goal: removed {} of the replaced mission: {}\n",
             dropped.size() == 1 ? "the expectation" : "the expectations", join(dropped, ", "));
}

/// Scenario of a branch: that of the other run with the overrides.
Scenario branch_scenario(const RunOptions& options) {
  for (const auto& [option, is_given] :
       {std::pair{"a scenario", !options.scenario.empty()}, std::pair{"--goal", !options.goals.empty()},
        std::pair{"--robot", options.robot.has_value()}, std::pair{"--seed", options.seed.has_value()},
        std::pair{"--stack", options.stack.has_value()}}) {
    if (is_given) throw InputError(fmt::format("--from: excludes {}: those of the run apply", option));
  }
  const std::filesystem::path file = open_run_directory(parse_branch(options.from).run).scenario();
  Scenario scenario = load_scenario(file, options.overrides);
  check_expected_metrics(scenario, {file.string(), options.overrides});
  return scenario;
}

Scenario scenario_of(const RunOptions& options) {
  if (!options.from.empty()) return branch_scenario(options);
  if (options.scenario.empty()) throw InputError("run: needs a scenario, or --from RUN@SECONDS");
  std::vector<std::string> overrides = options.overrides;
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  if (options.robot) overrides.push_back(fmt::format("robot={}", *options.robot));
  std::filesystem::path file = options.scenario;
  if (const std::optional<std::string> world = named_world(options)) {
    file.clear();
    overrides.push_back(fmt::format("world={}", *world));
  }
  if (!options.goals.empty()) {
    const std::filesystem::path data_root = find_data_root(file);
    std::optional<Scenario> given;
    if (!file.empty()) given = load_scenario(file, overrides);
    const std::vector<std::string> tour = overrides_of(tour_of(options, given ? &*given : nullptr, data_root));
    overrides.insert(overrides.end(), tour.begin(), tour.end());
  }
  Scenario scenario = load_scenario(file, overrides);
  if (!options.goals.empty()) drop_expectations_of_mission(options, scenario);
  check_expected_metrics(scenario, {file.string(), overrides});
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
  void end_simulation() override {
    for (RunObserver* one : observers_) one->end_simulation();
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
  RunMode mode{.snapshot_period_s = options.snapshot_period_s,
               .num_threads = options.threads.value_or(std::thread::hardware_concurrency() > 1 ? 2 : 1)};
  std::filesystem::path file = named_world(options) ? "" : options.scenario;
  if (!options.from.empty()) {
    mode.branch = parse_branch(options.from);
    file = RunDirectory{mode.branch->run}.scenario();
  }
  const std::filesystem::path data_root = find_data_root(file);
  if (reporter == nullptr) return run_once(scenario, name, data_root, root, screen, mode);
  ObserverGroup observers({&screen, reporter});
  try {
    std::optional<RunVerdict> verdict = run_once(scenario, name, data_root, root, observers, mode);
    if (!verdict) reporter->finish("interrupted", "interrupted by user");
    else
      reporter->finish(verdict->code() == ExitCode::kDone ? "finished" : "failed",
                       verdict->message.empty() ? std::string(name_of(verdict->end))
                                                : fmt::format("{}: {}", name_of(verdict->end), verdict->message));
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

/// Prints a warning for each fault and kidnap that the run does not reach.
void warn_of_late_events(const Scenario& scenario) {
  const auto warn = [&](const std::string& event) {
    fmt::print(stderr, "patrol: warning: {}: not before the time limit of {:g} s\n", event, scenario.time_limit_s);
  };
  for (const sim::FaultSettings& fault : scenario.faults) {
    if (fault.start_s >= scenario.time_limit_s) warn(app::name_of(fault));
  }
  for (const KidnapSettings& kidnap : scenario.kidnaps) {
    if (kidnap.at_s >= scenario.time_limit_s) warn(app::name_of(kidnap));
  }
}

/// Prints a warning if the legs of the robot walked with joints that are far too slow: only the check of a robot
/// compares joint speeds with their limits.
void warn_of_slow_joints(const RunOptions& options, const Scenario& scenario) {
  constexpr double kMaxRatio = 1.5;  // above what gaits are adapted to (sim/locomotion/swing_speed.h)
  if (!options.from.empty()) return;
  const std::filesystem::path data_root = find_data_root(named_world(options) ? "" : options.scenario);
  const RobotDescription robot = load_robot(scenario.robot, data_root, scenario.mounts).description;
  if (robot.legs.empty()) return;
  const double ratio = sim::peak_swing_speed_ratio(robot, scenario.locomotion, scenario.locomotion.max_forward_mps);
  if (ratio <= kMaxRatio) return;
  fmt::print(
      stderr,
      "patrol: warning: {}: the swing of a walk at {:.2f} m/s needs {:.1f} times the speed limits of the joints, "
      "which are not simulated: see patrol check {}\n",
      scenario.robot, scenario.locomotion.max_forward_mps, ratio, scenario.robot);
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
  for (const auto& [option, is_given] : {std::pair{"--robot-name", options.robot_name.has_value()},
                                         std::pair{"--monitor-token-file", options.monitor_token_file.has_value()}}) {
    if (is_given && !options.monitor_url) throw InputError(fmt::format("{}: needs --monitor-url", option));
  }
  const Scenario scenario = scenario_of(options);
  warn_of_late_events(scenario);
  const std::string name = name_of(options);
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

  warn_of_slow_joints(options, scenario);
  const std::string robot = named_world(options) ? scenario.robot + ", " : "";  // which the user may not have named
  const std::string title = fmt::format("{}/{}, {}seed {}", scenario.world, name, robot, scenario.seed);
  print_result(options.form,
               options.show_all ? run_details(title, *verdict, root, output_style())
                                : run_summary(title, *verdict, root, output_style()),
               run_json(*verdict, root));
  return verdict->code();
}

}  // namespace patrol::app
