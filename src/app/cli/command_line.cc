#include "app/cli/command_line.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/cli/commands.h"
#include "core/error.h"
#include "io/files/one_line.h"

namespace patrol::app {
namespace {

/// Options of all commands, and the command to call.
struct Call {
  RunOptions run;
  ScoreOptions score;
  LocalizabilityOptions localizability;
  ReplayOptions replay;
  ReportOptions report;
  std::filesystem::path verify_run;
  SweepOptions sweep;
  std::filesystem::path collect_root;
  std::vector<std::filesystem::path> collect_parts;
  BudgetOptions budget;
  FaultsOptions faults;
  SlamOptions slam;
  CalibrateOptions calibrate;
  TrainOptions train;
  SolveOptions solve;
  PlanOptions plan;
  StudyOptions study;
  TestOptions test;
  MonitorOptions monitor;
  SendOptions send;
  std::function<ExitCode()> chosen;
};

void add_run(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("run", "Run a scenario headless and score it");
  command->add_option("scenario", call.run.scenario, "Scenario file (YAML)")->required();
  command->add_option("--set", call.run.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--seed", call.run.seed, "Seed of every random stream");
  command->add_flag("--watch", call.run.watch, "Show the run on the terminal while it goes: map, robot, figures, events");
  command->add_option("--out", call.run.out, "Run directory to leave");
  command->add_option("--report-to", call.run.report_to, "Tell a monitoring platform: http://host:port");
  command->add_option("--report-token-file", call.run.report_token_file, "File of the platform's token (default: PATROL_TOKEN)");
  command->add_option("--robot-name", call.run.robot_name, "As the platform shall know it (default: robot and seed)");
  command->callback([&] { call.chosen = [&] { return run_command(call.run); }; });
}

void add_score(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("score", "Score a run, a trajectory or a map");
  command->add_option("run", call.score.run, "Run directory");
  command->add_option("--estimate", call.score.estimate, "Estimated trajectory (TUM)");
  command->add_option("--reference", call.score.reference, "Reference trajectory (TUM)");
  command->add_option("--relations", call.score.relations, "Reference relations (Freiburg: t1 t2 x y z roll pitch yaw)");
  score::RelationSettings& relations = call.score.relation_settings;
  command->add_option("--max-dt", relations.max_dt_s, "A pose within this of a relation's stamp is taken as it is, s")->capture_default_str();
  command->add_option("--ref-x", relations.ref_x_m, "How far ahead of the body the relations' point lies, m")->capture_default_str();
  command->add_option("--map", call.score.map, "Built map (map_server YAML)");
  command->add_option("--reference-map", call.score.reference_map, "Reference map (map_server YAML)");
  command->callback([&] { call.chosen = [&] { return score_command(call.score); }; });
}

void add_localizability(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("localizability", "Where a world's surfaces tell a lidar its place, and where they do not: a heat map");
  command->add_option("scenario", call.localizability.scenario, "Scenario file (YAML)")->required();
  command->add_option("--set", call.localizability.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--step-m", call.localizability.step_m, "From place to place, m")->capture_default_str();
  command->add_option("--out", call.localizability.out, "Directory to leave")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return localizability_command(call.localizability); }; });
}

void add_replay(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("replay", "Render a run from its log");
  command->add_option("run", call.replay.run, "Run directory")->required();
  command->add_option("--cut", call.replay.style, "story (slow and near at the notable moments) or plain (even)")->capture_default_str();
  command->add_option("--camera", call.replay.camera, "chase, top or onboard")->capture_default_str();
  command->add_option("--speed", call.replay.speed, "Simulated seconds per second of video")->capture_default_str();
  command->add_option("--slow", call.replay.slow, "Likewise, at the moments of a story")->capture_default_str();
  command->add_option("--renderer", call.replay.renderer, "auto, egl or osmesa")->capture_default_str();
  command->add_option("--size", call.replay.size, "Width x height, pixels")->capture_default_str();
  command->add_option("--still", call.replay.still_s, "One picture (PNG) of this instant instead, s");
  command->add_option("--out", call.replay.out, "File to write");
  command->callback([&] { call.chosen = [&] { return replay_command(call.replay); }; });
}

void add_report(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("report", "One HTML page that tells all of a run, a sweep, a budget or a fault matrix, and fetches nothing");
  command->add_option("directory", call.report.directory, "Directory of a run or of a sweep")->required();
  command->add_option("--out", call.report.out, "File to write (default: report.html in the directory)");
  command->callback([&] { call.chosen = [&] { return report_command(call.report); }; });
}

void add_verify(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("verify", "Run a run again and name the first difference");
  command->add_option("run", call.verify_run, "Run directory")->required();
  command->callback([&] { call.chosen = [&] { return verify_command(call.verify_run); }; });
}

void add_batch(CLI::App& command, BatchOptions& batch) {
  command.add_option("--jobs", batch.jobs, "Runs at a time; 0: one for each core")->capture_default_str();
  command.add_option("--run-limit-s", batch.run_limit_s, "Wall time of a run after which it is given up, s")->capture_default_str();
  command.add_option("--keep", batch.keep, "Run directories that stay: none, failed, all")->capture_default_str();
}

/// Adds the options that sweep, budget and faults share. `metrics` and `out` are the help texts of two of them.
template <typename Options>
void add_variants(CLI::App& command, Options& options, const char* metrics, const char* out) {
  command.add_option("scenario", options.scenario, "Scenario file (YAML)")->required();
  command.add_option("--set", options.overrides, "Override a setting in every run: path=value; may be repeated")->take_all();
  command.add_option("--seeds", options.seeds, "N (seeds 1 ... N) or A..B")->capture_default_str();
  command.add_option("--metric", options.metrics, metrics)->take_all()->capture_default_str();
  add_batch(command, options.batch);
  command.add_option("--out", options.out, out)->capture_default_str();
}

void add_sweep(CLI::App& app, Call& call) {
  SweepOptions& sweep = call.sweep;
  CLI::App* command = app.add_subcommand("sweep", "Run variants of a scenario with many seeds and compare them");
  add_variants(*command, sweep, "Figures to compare; may be repeated", "Directory of the sweep; results that lie there are not made again");
  command->add_option("--vary", sweep.vary,
                      "path=a,b,c or path=range:FROM:TO:N, logrange:...: a variant for each; or uniform:LOW:HIGH, loguniform:LOW:HIGH, "
                      "normal:MEAN:STD: a draw for each seed; may be repeated")->take_all();
  command->add_flag("--stop-when-decided", sweep.stop_when_decided, "Leave off once the first metric is decided");
  command->add_option("--margin", sweep.margin, "Differences of the first metric below this do not matter")->capture_default_str();
  command->add_option("--shard", sweep.shard, "i/n: do only this part of the runs");
  command->add_option("--engine", sweep.engine, "local or slurm")->capture_default_str();
  command->add_option("--slurm-tasks", sweep.slurm_tasks, "Tasks of the job array, each a shard")->capture_default_str();
  command->add_option("--slurm-option", sweep.slurm_options, "Option for sbatch, --slurm-option=--partition=long; may be repeated")->take_all();
  command->add_flag("--detach", sweep.detach, "Submit to Slurm and do not wait");
  command->callback([&] { call.chosen = [&] { return sweep_command(call.sweep); }; });
}

void add_collect(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("collect", "Put the shards of a sweep together");
  command->add_option("sweep", call.collect_root, "Directory of the sweep")->required();
  command->add_option("parts", call.collect_parts, "Directories of shards whose results to take over");
  command->callback([&] { call.chosen = [&] { return collect_command(call.collect_root, call.collect_parts); }; });
}

void add_budget(CLI::App& app, Call& call) {
  BudgetOptions& budget = call.budget;
  CLI::App* command = app.add_subcommand("budget", "Who owns how much of the error: one imperfection made ideal at a time");
  add_variants(*command, budget, "Figures to take apart; may be repeated", "Directory of the budget; results that lie there are not made again");
  command->callback([&] { call.chosen = [&] { return budget_command(call.budget); }; });
}

void add_faults(CLI::App& app, Call& call) {
  FaultsOptions& faults = call.faults;
  CLI::App* command = app.add_subcommand("faults", "What each fault of each sensor leads to: survived, stopped, unsafe");
  add_variants(*command, faults, "Figures to set beside those without a fault; may be repeated",
               "Directory of the results; those that lie there are not made again");
  command->add_option("--start-s", faults.start_s, "When each fault begins, s")->capture_default_str();
  command->add_option("--duration-s", faults.duration_s, "How long it lasts, s")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return faults_command(call.faults); }; });
}

void add_slam(CLI::App& app, Call& call) {
  SlamOptions& slam = call.slam;
  CLI::App* command = app.add_subcommand("slam", "Map a recorded lidar log (CARMEN, MCAP)");
  command->add_option("log", slam.log, "Log file: CARMEN's text, plain or in gzip, or MCAP")->required();
  command->add_option("--method", slam.method, "How to map (patrol list)");
  command->add_option("--set", slam.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--calibration", slam.calibration, "calibration.yaml of patrol calibrate: the lidar's place, odometry put right");
  command->add_option("--seed", slam.seed, "Seed of every random stream");
  command->add_flag("--skip-bad-lines", slam.skip_bad_lines, "Use what can be read of a damaged log");
  command->add_option("--out", slam.out, "Directory to leave")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return slam_command(call.slam); }; });
}

void add_calibrate(CLI::App& app, Call& call) {
  CalibrateOptions& calibrate = call.calibrate;
  CLI::App* command = app.add_subcommand("calibrate", "Where a log's lidar sits and how far its odometry can be believed, from the log alone");
  command->add_option("log", calibrate.log, "Log file: CARMEN's text, plain or in gzip, or MCAP")->required();
  command->add_option("--set", calibrate.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_flag("--skip-bad-lines", calibrate.skip_bad_lines, "Use what can be read of a damaged log");
  command->add_option("--out", calibrate.out, "Directory to leave")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return calibrate_command(call.calibrate); }; });
}

void add_train(CLI::App& app, Call& call) {
  TrainOptions& train = call.train;
  CLI::App* command = app.add_subcommand("train-neighbours", "Learn to recognise neighbouring submaps from runs whose truth is known");
  command->add_option("runs", train.runs, "Run directories, of which is learnt")->required();
  command->add_option("--held-out", train.held_out, "Others, on which what was learnt is tried");
  command->add_option("--set", train.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--out", train.out, "Model to write (JSON)")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return train_command(call.train); }; });
}

void add_solve(CLI::App& app, Call& call) {
  SolveOptions& solve = call.solve;
  CLI::App* command = app.add_subcommand("solve", "Solve a pose graph in g2o's text");
  command->add_option("graph", solve.graph, "Pose graph (g2o)")->required();
  command->add_flag("--doubt-loops", solve.robust_loop_closures, "A robust loss on the edges that are not odometry");
  command->add_option("--out", solve.out, "Solved graph to write (g2o)")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return solve_command(call.solve); }; });
}

void add_plan(CLI::App& app, Call& call) {
  PlanOptions& plan = call.plan;
  CLI::App* command = app.add_subcommand("plan", "A route on anybody's map, a tour of many stations, or every problem of a .scen file");
  command->add_option("map", plan.map, "map_server YAML, MovingAI .map, or a .scen file of problems, its map beside it")->required();
  command->add_option("--from", plan.from, "X,Y: metres in the map's frame; of a MovingAI map cells from the upper left, y down");
  command->add_option("--to", plan.to, "X,Y likewise; of a tour where it ends (default: back at the start)");
  command->add_option("--stations", plan.stations, "Visit these (CSV: name, x, y and, if wanted, service_s, earliest_s, latest_s, priority)");
  command->add_option("--planner", plan.planner, "By which planner (patrol list)");
  command->add_option("--robot", plan.robot, "Inflate by this robot's outline, with the costmap that it drives by (default: a point)");
  command->add_option("--radius-m", plan.radius_m, "Or by a disc's, m");
  command->add_flag("--smooth", plan.smooth, "Straighten the route where that keeps its clearance");
  command->add_option("--speed-mps", plan.speed_mps, "On a tour, m/s (default: the robot's, or 1)");
  command->add_option("--seed", plan.seed, "Seed of planners that draw");
  command->add_option("--set", plan.overrides, "Override a setting: path=value; may be repeated")->take_all();
  command->add_option("--out", plan.out, "Directory to leave");
  command->callback([&] { call.chosen = [&] { return plan_command(call.plan); }; });
}

void add_study(CLI::App& app, Call& call) {
  StudyOptions& study = call.study;
  CLI::App* command = app.add_subcommand("study", "A paper's experiment: its published figures beside ours");
  command->add_option("name", study.name, "Which one (patrol list)")->required();
  command->add_option("--seeds", study.seeds, "N (the first N that nothing was tuned on) or A..B");
  command->add_option("--jobs", study.jobs, "Seeds at a time; 0: one for each core")->capture_default_str();
  command->add_option("--out", study.out, "Directory to leave; seeds that lie there are not run again")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return study_command(call.study); }; });
}

void add_test(CLI::App& app, Call& call) {
  TestOptions& test = call.test;
  CLI::App* command = app.add_subcommand("test", "Run every scenario of a folder and leave JUnit XML and a summary");
  command->add_option("scenarios", test.scenarios, "Folder of scenarios, or one of them")->required();
  command->add_option("--set", test.overrides, "Override a setting in every run: path=value; may be repeated")->take_all();
  add_batch(*command, test.batch);
  command->add_option("--out", test.out, "Directory to leave")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return test_command(call.test); }; });
}

void add_monitor(CLI::App& app, Call& call) {
  MonitorOptions& monitor = call.monitor;
  CLI::App* command = app.add_subcommand("monitor", "The monitoring platform: takes results from robots and shows them, until it is interrupted");
  command->add_option("--port", monitor.port, "Port to listen at; 0: any that is free")->capture_default_str();
  command->add_option("--host", monitor.host, "Address or host name to listen at; 0.0.0.0: of every network")->capture_default_str();
  command->add_option("--allow-host", monitor.allowed_hosts, "Host name under which it is reached, besides its address; may be repeated");
  command->add_option("--data", monitor.data, "Directory of what it keeps")->capture_default_str();
  command->add_option("--token", monitor.token_file, "File of the token (default: PATROL_TOKEN, else one is made in the directory)");
  command->callback([&] { call.chosen = [&] { return monitor_command(call.monitor); }; });
}

void add_send(CLI::App& app, Call& call) {
  SendOptions& send = call.send;
  CLI::App* command = app.add_subcommand("send", "Send what of a run's results still waits for the monitoring platform");
  command->add_option("run", send.run, "Run directory")->required();
  command->add_option("--to", send.to, "Platform: http://host:port")->required();
  command->add_option("--token", send.token_file, "File of the platform's token (default: PATROL_TOKEN)");
  command->add_option("--limit-s", send.limit_s, "Give up after so long without an answer, s")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return send_command(call.send); }; });
}

void add_list(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("list", "Worlds, scenarios, robots, sensors, methods");
  command->callback([&] { call.chosen = [] { return list_command(); }; });
}

/// Throws InputError for an unknown command; the message of CLI11 would only be that a command is required.
void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());
  if (word.starts_with('-') || std::find(known.begin(), known.end(), word) != known.end()) return;
  throw InputError(fmt::format("there is no command '{}' (known: {})", word, fmt::join(known, ", ")));
}

/// Prints an error; does not throw if standard error is not writable.
int report(const std::string& what, ExitCode code) {
  std::fputs(fmt::format("patrol: {}\n", io::on_one_line(what)).c_str(), stderr);  // fmt::print would throw on failure
  return static_cast<int>(code);
}

/// Accepts decimal digits only. CLI11 converts -1 to 2^64 - 1, and 010 to 8.
std::string refuse_bad_seed(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_octal = text.size() > 1 && text.front() == '0';
  if (error == std::errc() && end == text.data() + text.size() && !is_octal) return "";
  return fmt::format("{} is no seed: must be a whole number in 0 ... {}", text, std::numeric_limits<std::uint64_t>::max());
}

/// Refuses numbers beyond all times, lengths and speeds in use. CLI11 converts 1e400 to infinity.
std::string refuse_bad_number(const std::string& text) {
  constexpr double kMaxNumber = 1e9;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::abs(value) <= kMaxNumber) return "";
  return fmt::format("{} is out of range: must be a number in -1e9 ... 1e9", text);
}

/// Adds checks that CLI11 lacks to every option of every command, by the type of its value.
void add_number_checks(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands({})) {
    for (CLI::Option* option : command->get_options()) {
      const std::string type = option->get_type_name();
      if (type == "UINT") option->check(CLI::Validator(refuse_bad_seed, "", "seed"));
      if (type == "FLOAT") option->check(CLI::Validator(refuse_bad_number, "", "number"));
    }
  }
}

/// Parses the command line and runs its command. Exceptions become one line on standard error.
int run_parsed(CLI::App& app, Call& call, int argc, const char* const* argv) {
  try {
    refuse_unknown_command(app, argc, argv);
    app.parse(argc, argv);
    return static_cast<int>(call.chosen());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const InputError& error) {
    return report(error.what(), ExitCode::kWrongInput);
  } catch (const std::exception& error) {
    return report(error.what(), ExitCode::kProgramFailed);
  }
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  mju_user_warning = [](const char* text) { fmt::print(stderr, "mujoco: {}\n", text); };  // default: a file
  CLI::App app("Patrol: a digital twin for inspection robots");
  app.set_version_flag("--version", PATROL_VERSION);
  app.require_subcommand(1);

  Call call;
  for (const auto add : {add_run, add_score, add_localizability, add_replay, add_report, add_verify, add_sweep, add_collect, add_budget, add_faults,
                         add_slam, add_calibrate, add_train, add_solve, add_plan, add_study, add_test, add_monitor, add_send, add_list}) {
    add(app, call);
  }
  add_number_checks(app);

  const int code = run_parsed(app, call, argc, argv);
  const bool is_written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_written || code == static_cast<int>(ExitCode::kWrongInput) || code == static_cast<int>(ExitCode::kProgramFailed)) return code;
  return report(fmt::format("standard output: cannot be written: {}", std::strerror(errno)), ExitCode::kProgramFailed);
}

}  // namespace patrol::app
