#include "app/cli/command_line.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/cli/command_texts.h"
#include "app/cli/commands.h"
#include "app/cli/number_checks.h"
#include "app/cli/reference.h"
#include "app/cli/renamed_options.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/text.h"
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
  MergeOptions merge;
  ErrorBudgetOptions error_budget;
  FaultMatrixOptions fault_matrix;
  SlamOptions slam;
  CalibrateOptions calibrate;
  TrainOptions train;
  SolveOptions solve;
  PlanOptions plan;
  StudyOptions study;
  TestOptions test;
  MonitorOptions monitor;
  UploadOptions upload;
  ListOptions list;
  std::string printed_text;
  std::function<ExitCode()> chosen;
};

constexpr const char* kSetHelp = "Override a setting, path=value (repeatable)";
constexpr const char* kSetAllHelp = "Override a setting in every run, path=value (repeatable)";
constexpr const char* kSeedHelp = "Random seed";
constexpr const char* kOutHelp = "Output directory";
constexpr const char* kSkipHelp = "Skip unreadable records of a damaged log";
constexpr const char* kLogHelp = "Log file: CARMEN text (plain or gzip) or MCAP";
constexpr const char* kAllHelp = "Print every metric";
constexpr const char* kTokenHelp = "File with the access token (default: $PATROL_TOKEN)";

void add_scenario(CLI::App& command, std::filesystem::path& scenario) {
  command.add_option("scenario", scenario, "Scenario file (YAML), or WORLD/NAME, for example street/patrol")
      ->required()
      ->transform([](const std::string& name) { return find_scenario(name).string(); });
}

/// Adds `--json` to a command that prints a table.
void add_json(CLI::App& command, ResultForm& form) {
  command.add_flag_callback(
      "--json", [&form] { form = ResultForm::kJson; }, "Print the results as JSON");
}

void add_run(CLI::App& app, Call& call) {
  RunOptions& run = call.run;
  CLI::App* command = app.add_subcommand("run", "Run a scenario headless and score it");
  add_scenario(*command, run.scenario);
  command->add_option("--set", run.overrides, kSetHelp)->take_all();
  command->add_option("--seed", run.seed, kSeedHelp);
  command->add_flag("--watch", run.watch, "Show live status in the terminal");
  command->add_option("--out", run.out, kOutHelp);
  command->add_option("--monitor-url", run.monitor_url, "Monitoring server, http://host:port");
  command->add_option("--monitor-token-file", run.monitor_token_file, kTokenHelp);
  command->add_option("--robot-name", run.robot_name, "Robot name shown by the monitor (default: robot and seed)");
  command->add_flag("--all", run.show_all, kAllHelp);
  add_json(*command, run.form);
  command->callback([&] { call.chosen = [&] { return run_command(call.run); }; });
}

void add_score(CLI::App& app, Call& call) {
  ScoreOptions& score = call.score;
  CLI::App* command = app.add_subcommand("score", "Evaluate a run, a trajectory or a map");
  command->add_option("run", score.run, "Run directory");
  command->add_option("--estimate", score.estimate, "Estimated trajectory (TUM)");
  command->add_option("--reference", score.reference, "Reference trajectory (TUM)");
  command->add_option("--relations", score.relations, "Reference relations (Freiburg: t1 t2 x y z roll pitch yaw)");
  score::RelationSettings& relations = score.relation_settings;
  command->add_option("--max-dt-s", relations.max_dt_s, "Maximum time difference for nearest-pose association, s")
      ->capture_default_str();
  command->add_option("--reference-x-m", relations.reference_x_m, "Offset of the reference point along body x, m")
      ->capture_default_str();
  command->add_option("--map", score.map, "Built map (map_server YAML)");
  command->add_option("--reference-map", score.reference_map, "Reference map (map_server YAML)");
  command->add_flag("--all", score.show_all, kAllHelp);
  add_json(*command, score.form);
  command->callback([&] { call.chosen = [&] { return score_command(call.score); }; });
}

void add_localizability(CLI::App& app, Call& call) {
  LocalizabilityOptions& localizability = call.localizability;
  CLI::App* command = app.add_subcommand("localizability", "Map the accuracy bound of lidar localization");
  add_scenario(*command, localizability.scenario);
  command->add_option("--set", localizability.overrides, kSetHelp)->take_all();
  command->add_option("--grid-step-m", localizability.grid_step_m, "Grid spacing, m")->capture_default_str();
  command->add_option("--out", localizability.out, kOutHelp)->capture_default_str();
  command->callback([&] { call.chosen = [&] { return localizability_command(call.localizability); }; });
}

void add_replay(CLI::App& app, Call& call) {
  ReplayOptions& replay = call.replay;
  CLI::App* command = app.add_subcommand("replay", "Render a video or a still image from a run log");
  command->add_option("run", replay.run, "Run directory")->required();
  command->add_option("--style", replay.style, "Editing style: highlights or continuous")->capture_default_str();
  command->add_option("--camera", replay.camera, "Camera: chase, top or onboard")->capture_default_str();
  command->add_option("--speed", replay.speed, "Playback speed, simulated seconds per second of video")
      ->capture_default_str();
  command->add_option("--highlight-speed", replay.highlight_speed, "Playback speed during highlights")
      ->capture_default_str();
  command->add_option("--fps", replay.frames_per_second, "Frames per second of the video")->capture_default_str();
  command->add_option("--jobs", replay.jobs, "Processes that render (0: one per core)")->capture_default_str();
  command->add_option("--renderer", replay.renderer, "OpenGL implementation: auto, egl or osmesa")
      ->capture_default_str();
  command->add_option("--size", replay.size, "Width x height, pixels")->capture_default_str();
  command->add_option("--still", replay.still_s, "Time of a single image (PNG) instead of a video, s");
  command->add_option("--out", replay.out, "Output file: .mp4, .webp (animated picture), or .png with --still");
  command->callback([&] { call.chosen = [&] { return replay_command(call.replay); }; });
}

void add_report(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("report", "Generate a self-contained HTML report");
  command
      ->add_option("directory", call.report.directory, "Directory of a run, a sweep, an error budget or a fault matrix")
      ->required();
  command->add_option("--out", call.report.out, "Output file (default: report.html in the directory)");
  command->callback([&] { call.chosen = [&] { return report_command(call.report); }; });
}

void add_verify(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("verify", "Rerun a scenario and compare the logs byte by byte");
  command->add_option("run", call.verify_run, "Run directory")->required();
  command->callback([&] { call.chosen = [&] { return verify_command(call.verify_run); }; });
}

void add_batch(CLI::App& command, BatchOptions& batch) {
  command.add_option("--jobs", batch.jobs, "Parallel runs (0: one per core)")->capture_default_str();
  command.add_option("--run-timeout-s", batch.run_timeout_s, "Wall-clock timeout per run, s")->capture_default_str();
  command.add_option("--keep-runs", batch.keep_runs, "Run directories to keep: none, failed, all")
      ->capture_default_str();
}

/// Adds the options that sweep, error-budget and fault-matrix have in common. `metrics`: help text of --metric.
template <typename Options>
void add_variants(CLI::App& command, Options& options, const char* metrics) {
  add_scenario(command, options.scenario);
  command.add_option("--set", options.overrides, kSetAllHelp)->take_all();
  command.add_option("--seeds", options.seeds, "Seeds: N (1 ... N) or A..B")->capture_default_str();
  command.add_option("--metric", options.metrics, metrics)->take_all()->capture_default_str();
  add_batch(command, options.batch);
  command.add_option("--out", options.out, "Output directory; existing results are reused")->capture_default_str();
}

void add_sweep(CLI::App& app, Call& call) {
  SweepOptions& sweep = call.sweep;
  CLI::App* command = app.add_subcommand("sweep", "Run variants of a scenario and compare them");
  add_variants(*command, sweep, "Metric to compare (repeatable)");
  command
      ->add_option("--vary", sweep.vary,
                   "Parameter axis (repeatable): path=a,b,c or path=range:FROM:TO:N or logrange:..., one variant per "
                   "value; path=uniform:LOW:HIGH, loguniform:LOW:HIGH or normal:MEAN:STD, one sample per seed")
      ->take_all();
  command->add_flag("--early-stop", sweep.early_stop, "Stop a variant once its difference is significant");
  command->add_option("--equivalence-margin", sweep.equivalence_margin, "Differences below this are treated as equal")
      ->capture_default_str();
  command->add_option("--shard", sweep.shard, "Process shard i/n of the runs");
  command->add_option("--engine", sweep.engine, "Execution engine: local or slurm")->capture_default_str();
  command->add_option("--slurm-tasks", sweep.slurm_tasks, "Tasks of the Slurm job array, one shard each")
      ->capture_default_str();
  command
      ->add_option("--slurm-option", sweep.slurm_options,
                   "Option for sbatch (repeatable): --slurm-option=--partition=long")
      ->take_all();
  command->add_flag("--detach", sweep.detach, "Submit to Slurm without waiting");
  add_json(*command, sweep.form);
  command->callback([&] { call.chosen = [&] { return sweep_command(call.sweep); }; });
}

void add_merge(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("merge", "Merge the shards of a sweep");
  command->add_option("sweep", call.merge.root, "Directory of the sweep")->required();
  command->add_option("parts", call.merge.parts, "Directories of the shards");
  add_json(*command, call.merge.form);
  command->callback([&] { call.chosen = [&] { return merge_command(call.merge); }; });
}

void add_error_budget(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("error-budget", "Rerun with one error source removed at a time");
  command->alias("budget");
  add_variants(*command, call.error_budget, "Metric to analyze (repeatable)");
  add_json(*command, call.error_budget.form);
  command->callback([&] { call.chosen = [&] { return error_budget_command(call.error_budget); }; });
}

void add_fault_matrix(CLI::App& app, Call& call) {
  FaultMatrixOptions& faults = call.fault_matrix;
  CLI::App* command = app.add_subcommand("fault-matrix", "Inject every fault into every sensor");
  command->alias("faults");
  add_variants(*command, faults, "Metric to compare with the fault-free run (repeatable)");
  command->add_option("--fault", faults.faults, "Only this fault, e.g. 'lidar: dropout' (repeatable)")->take_all();
  command->add_option("--start-s", faults.start_s, "Fault onset, s")->capture_default_str();
  command->add_option("--duration-s", faults.duration_s, "Fault duration, s")->capture_default_str();
  command->add_option("--max-error-m", faults.max_error_m, "Largest position error of a survived run, m")
      ->capture_default_str();
  command->add_option("--min-map-coverage", faults.min_map_coverage, "Smallest map coverage of a survived run")
      ->capture_default_str();
  command->add_option("--max-lost-s", faults.max_lost_s, "Longest time reported lost on a given map, s")
      ->capture_default_str();
  add_json(*command, faults.form);
  command->callback([&] { call.chosen = [&] { return fault_matrix_command(call.fault_matrix); }; });
}

void add_slam(CLI::App& app, Call& call) {
  SlamOptions& slam = call.slam;
  CLI::App* command = app.add_subcommand("slam", "Build a map from a recorded 2D lidar log (CARMEN, MCAP)");
  command->add_option("log", slam.log, kLogHelp)->required();
  command->add_option("--method", slam.method, "Mapping method (see 'patrol list')");
  command->add_option("--set", slam.overrides, kSetHelp)->take_all();
  command->add_option("--calibration", slam.calibration, "Calibration file of 'patrol calibrate'");
  command->add_option("--map", slam.earlier_map, "Earlier output directory of 'patrol slam', whose map is extended");
  command->add_option("--seed", slam.seed, kSeedHelp);
  command->add_flag("--skip-invalid", slam.skip_invalid, kSkipHelp);
  command->add_option("--out", slam.out, kOutHelp)->capture_default_str();
  add_json(*command, slam.form);
  command->callback([&] { call.chosen = [&] { return slam_command(call.slam); }; });
}

void add_calibrate(CLI::App& app, Call& call) {
  CalibrateOptions& calibrate = call.calibrate;
  CLI::App* command = app.add_subcommand("calibrate", "Calibrate lidar pose and odometry scale from a log");
  command->add_option("log", calibrate.log, kLogHelp)->required();
  command->add_option("--set", calibrate.overrides, kSetHelp)->take_all();
  command->add_flag("--skip-invalid", calibrate.skip_invalid, kSkipHelp);
  command->add_option("--out", calibrate.out, kOutHelp)->capture_default_str();
  add_json(*command, calibrate.form);
  command->callback([&] { call.chosen = [&] { return calibrate_command(call.calibrate); }; });
}

void add_train(CLI::App& app, Call& call) {
  TrainOptions& train = call.train;
  CLI::App* command = app.add_subcommand("train-neighbors", "Train the submap-neighbor classifier");
  command->add_option("runs", train.runs, "Run directories for training")->required();
  command->add_option("--validation", train.validation, "Run directories for validation");
  command->add_option("--set", train.overrides, kSetHelp)->take_all();
  command->add_option("--out", train.out, "Output file (JSON)")->capture_default_str();
  add_json(*command, train.form);
  command->callback([&] { call.chosen = [&] { return train_command(call.train); }; });
}

void add_solve(CLI::App& app, Call& call) {
  SolveOptions& solve = call.solve;
  CLI::App* command = app.add_subcommand("solve", "Optimize a pose graph (g2o)");
  command->add_option("graph", solve.graph, "Pose graph (g2o)")->required();
  command->add_flag("--robust-loops", solve.robust_loop_closures, "Use a robust loss on loop closures");
  command->add_option("--out", solve.out, "Output file (g2o)")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return solve_command(call.solve); }; });
}

void add_plan(CLI::App& app, Call& call) {
  PlanOptions& plan = call.plan;
  CLI::App* command = app.add_subcommand("plan", "Plan a path, a station order, or a MovingAI benchmark");
  command->add_option("map", plan.map, "map_server YAML, MovingAI .map, or a .scen file next to its map")->required();
  command->add_option("--from", plan.from,
                      "Start X,Y: meters in the map's frame; on a MovingAI map cells from the upper left, y down");
  command->add_option("--to", plan.to, "Goal X,Y; with --stations the end (default: back to the start)");
  command->add_option("--stations", plan.stations,
                      "Stations to visit (CSV: name, x, y and optionally service_s, earliest_s, latest_s, priority)");
  command->add_option("--planner", plan.planner, "Global planner (see 'patrol list')");
  command->add_option("--robot", plan.robot, "Robot whose footprint and costmap are used (default: a point)");
  command->add_option("--radius-m", plan.radius_m, "Disc footprint radius, m");
  command->add_flag("--smooth", plan.smooth, "Smooth the path without losing clearance");
  command->add_option("--speed-mps", plan.speed_mps, "Speed between stations, m/s (default: the robot's, or 1)");
  command->add_option("--seed", plan.seed, "Random seed of the planner");
  command->add_option("--set", plan.overrides, kSetHelp)->take_all();
  command->add_option("--out", plan.out, kOutHelp);
  add_json(*command, plan.form);
  command->callback([&] { call.chosen = [&] { return plan_command(call.plan); }; });
}

void add_study(CLI::App& app, Call& call) {
  StudyOptions& study = call.study;
  CLI::App* command = app.add_subcommand("study", "Reproduce a published experiment");
  command->add_option("name", study.name, "Name of the study (see 'patrol list')")->required();
  command->add_option("--seeds", study.seeds, "Seeds: N (the first N that are not used for tuning) or A..B");
  command->add_option("--jobs", study.jobs, "Parallel seeds (0: one per core)")->capture_default_str();
  command->add_option("--out", study.out, "Output directory; existing seeds are reused")->capture_default_str();
  add_json(*command, study.form);
  command->callback([&] { call.chosen = [&] { return study_command(call.study); }; });
}

void add_test(CLI::App& app, Call& call) {
  TestOptions& test = call.test;
  CLI::App* command = app.add_subcommand("test", "Run all scenarios of a folder; write JUnit XML");
  command->add_option("scenarios", test.scenarios, "Folders of scenarios, and scenario files")->required();
  command->add_option("--set", test.overrides, kSetAllHelp)->take_all();
  CLI::Option* table =
      command->add_option("--seed-table", test.seed_table, "Seeds of scenarios (JSON: end of a scenario's path, seed)");
  CLI::Option* calibrate = command->add_option(
      "--calibrate", test.calibrate, "Propose expectations from seeds N (1 ... N) or A..B instead of testing");
  calibrate->excludes(table);
  command->add_flag("--write", test.write, "Write the proposed expectations to the scenarios")->needs(calibrate);
  command->add_flag("--widen", test.widen, "Allow proposals that are wider than the present ones")->needs(calibrate);
  add_batch(*command, test.batch);
  command->add_option("--out", test.out, "Output directory (default: out/test or out/calibration)");
  add_json(*command, test.form);
  command->callback([&] { call.chosen = [&] { return test_command(call.test); }; });
}

void add_monitor(CLI::App& app, Call& call) {
  MonitorOptions& monitor = call.monitor;
  CLI::App* command = app.add_subcommand("monitor", "Run the monitoring server until interrupted");
  command->add_option("--port", monitor.port, "TCP port (0: any free port)")->capture_default_str();
  command->add_option("--host", monitor.host, "Address or host name to listen on (0.0.0.0: all networks)")
      ->capture_default_str();
  command->add_option("--allow-host", monitor.allowed_hosts, "Host name accepted besides the address (repeatable)");
  command->add_option("--data-dir", monitor.data_dir, "Data directory")->capture_default_str();
  command->add_option("--token-file", monitor.token_file,
                      "File with the access token (default: $PATROL_TOKEN, else created in the data directory)");
  command->callback([&] { call.chosen = [&] { return monitor_command(call.monitor); }; });
}

void add_upload(CLI::App& app, Call& call) {
  UploadOptions& upload = call.upload;
  CLI::App* command = app.add_subcommand("upload", "Upload pending results of a run");
  command->add_option("run", upload.run, "Run directory")->required();
  command->add_option("--monitor-url", upload.monitor_url, "Monitoring server, http://host:port")->required();
  command->add_option("--token-file", upload.token_file, kTokenHelp);
  command->add_option("--timeout-s", upload.timeout_s, "Maximum time without progress, s")->capture_default_str();
  command->callback([&] { call.chosen = [&] { return upload_command(call.upload); }; });
}

void add_list(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("list", "List scenarios, robots, sensors, methods and metrics");
  command->add_option("section", call.list.section, "Section to print, for example metrics (default: all)");
  add_json(*command, call.list.form);
  command->callback([&] { call.chosen = [&] { return list_command(call.list); }; });
}

/// Texts of `patrol print`, by name.
const std::map<std::string, std::string (*)(const CLI::App&)> kPrintedTexts = {
    {"bash-completion", bash_completion},
    {"zsh-completion", zsh_completion},
    {"man-page", [](const CLI::App& app) { return man_page(app, PATROL_VERSION); }},
    {"reference", [](const CLI::App& app) { return reference_json(app).dump(1) + "\n"; }}};

void add_print(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("print", "Print a text about the program");
  std::vector<std::string> names;
  for (const auto& [name, text] : kPrintedTexts) names.push_back(name);
  command
      ->add_option("text", call.printed_text,
                   "bash-completion, zsh-completion, man-page, or reference: commands, settings, metrics, events and "
                   "topics as JSON")
      ->required()
      ->check(CLI::IsMember(names));
  command->callback([&] {
    call.chosen = [&] {
      std::cout << kPrintedTexts.at(call.printed_text)(app);
      return ExitCode::kDone;
    };
  });
}

/// Throws InputError for an unknown command; the message of CLI11 would only be that a command is required.
void refuse_unknown_command(const CLI::App& app, int argc, const char* const* argv) {
  const std::string word = argc > 1 ? argv[1] : "-";
  if (word.starts_with('-')) return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (command->check_name(word)) return;
    known.push_back(command->get_name());
  }
  throw InputError(fmt::format("unknown command '{}' (known: {})", word, join(known, ", ")));
}

/// Prints an error; does not throw if standard error is not writable.
int report(const std::string& what, ExitCode code) {
  std::fputs(fmt::format("patrol: {}\n", io::on_one_line(what)).c_str(), stderr);  // fmt::print would throw on failure
  return static_cast<int>(code);
}

/// Parses the command line and runs its command. Exceptions become one line on standard error.
int run_parsed(CLI::App& app, Call& call, int argc, const char* const* argv) {
  try {
    refuse_renamed(argc, argv);
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
  for (const auto add :
       {add_run,   add_score,        add_localizability, add_replay,  add_report,    add_verify, add_sweep,
        add_merge, add_error_budget, add_fault_matrix,   add_slam,    add_calibrate, add_train,  add_solve,
        add_plan,  add_study,        add_test,           add_monitor, add_upload,    add_list,   add_print}) {
    add(app, call);
  }
  add_number_checks(app);

  const int code = run_parsed(app, call, argc, argv);
  const bool is_written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_written || code == static_cast<int>(ExitCode::kWrongInput) ||
      code == static_cast<int>(ExitCode::kProgramFailed))
    return code;
  return report(fmt::format("cannot write standard output: {}", std::strerror(errno)), ExitCode::kProgramFailed);
}

}  // namespace patrol::app
