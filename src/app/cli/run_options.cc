#include "app/cli/command_options.h"
#include "app/cli/number_checks.h"

namespace patrol::app {
namespace {

void add_run(CLI::App& app, Call& call) {
  RunOptions& run = call.run;
  CLI::App* command = app.add_subcommand("run", "Run a scenario headless and score it");
  add_scenario(*command, run.scenario)->required(false);
  command->add_option("--set", run.overrides, kSetHelp)->take_all();
  command->add_option("--seed", run.seed, kSeedHelp);
  command->add_option("--robot", run.robot, "Robot instead of that of the scenario; of a world: quadruped");
  command
      ->add_option("--goal", run.goals,
                   "Goal X,Y or X,Y,DEG in the site instead of the mission (repeatable); the scenario may be a world")
      ->take_all();
  command->add_option("--start", run.start, "Start X,Y or X,Y,DEG in the site, with --goal")->needs("--goal");
  command->add_option("--stack", run.stack, kStackHelp);
  command->add_flag("--watch", run.watch, "Show live status in the terminal");
  command
      ->add_option("--threads", run.threads,
                   "Threads, 1 or 2, with the same results (default: $PATROL_THREADS, else 2 on several cores)")
      ->envname("PATROL_THREADS")
      ->check(CLI::Range(1, 2));
  command->add_option("--snapshot-every", run.snapshot_period_s, "Simulated time between two snapshots, s")
      ->check(above_zero());
  command->add_option("--from", run.from, "Branch RUN@SECONDS: continue that run, with --set from there on");
  command->add_option("--out", run.out, kOutHelp);
  command->add_option("--monitor-url", run.monitor_url, "Monitoring server, http://host:port");
  command->add_option("--monitor-token-file", run.monitor_token_file, kTokenHelp);
  command->add_option("--robot-name", run.robot_name, "Robot name shown by the monitor (default: robot and seed)");
  command->add_flag("--all", run.show_all, kAllHelp);
  add_json(*command, run.form);
  command->callback([&] { call.chosen = [&] { return run_command(call.run); }; });
}

void add_trace(CLI::App& app, Call& call) {
  TraceOptions& trace = call.trace;
  CLI::App* command = app.add_subcommand("trace", "Print hashes of the state of a run at every tick");
  command->add_option("run", trace.run, "Run directory")->required();
  command->add_option("--from-s", trace.from_s, "First instant, s")->check(not_negative())->capture_default_str();
  command->add_option("--to-s", trace.to_s, "Last instant, s")->check(not_negative())->required();
  command->callback([&] { call.chosen = [&] { return trace_command(call.trace); }; });
}

void add_bisect(CLI::App& app, Call& call) {
  BisectOptions& bisect = call.bisect;
  CLI::App* command = app.add_subcommand("bisect", "Find the first tick at which two runs differ");
  command->add_option("a", bisect.a, "Run directory")->required();
  command->add_option("b", bisect.b, "Run directory of the same scenario by other settings or another build")
      ->required();
  command->add_option("--program-a", bisect.program_a, "Program that made A (default: this one)");
  command->add_option("--program-b", bisect.program_b, "Program that made B (default: this one)");
  add_json(*command, bisect.form);
  command->callback([&] { call.chosen = [&] { return bisect_command(call.bisect); }; });
}

constexpr const char* kReferenceHelp = "Reference trajectory (TUM)";
constexpr const char* kRelationsHelp = "Reference relations (Freiburg: t1 t2 x y z roll pitch yaw)";

void add_association(CLI::App& command, AssociationOptions& association) {
  command
      .add_option("--max-dt-s", association.max_dt_s,
                  "Maximum time difference for nearest-pose association, s (default: 0.02 for relations, 0.01 for "
                  "the alignment to a reference)")
      ->check(CLI::Range(0.0, score::RelationSettings::kMaxDt_s));
  command
      .add_option("--reference-x-m", association.reference_x_m,
                  "Offset of the relations' reference point along body x, m")
      ->check(CLI::Range(-score::RelationSettings::kMaxReference_m, score::RelationSettings::kMaxReference_m))
      ->capture_default_str();
}

void add_score(CLI::App& app, Call& call) {
  ScoreOptions& score = call.score;
  CLI::App* command = app.add_subcommand("score", "Evaluate a run, a trajectory or a map");
  command->add_option("run", score.run, "Run directory");
  command->add_option("--estimate", score.estimate, "Estimated trajectory (TUM)");
  command->add_option("--reference", score.reference, kReferenceHelp);
  command->add_option("--relations", score.relations, kRelationsHelp);
  add_association(*command, score.association);
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

void add_check(CLI::App& app, Call& call) {
  CheckOptions& check = call.check;
  CLI::App* command = app.add_subcommand("check", "Check a robot on plane, ramp and steps");
  command->add_option("robot", check.robot, "Name of the robot, a folder of models")->required();
  command->add_option("--set", check.overrides, kSetHelp)->take_all();
  command->add_option("--seed", check.seed, kSeedHelp);
  command->add_option("--out", check.out, kOutHelp)->capture_default_str();
  command->add_option("--mjcf", check.mjcf, "Write the robot on a plane as MJCF to this file instead of driving it");
  add_json(*command, check.form);
  command->callback([&] { call.chosen = [&] { return check_command(call.check); }; });
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
  VerifyOptions& verify = call.verify;
  CLI::App* command = app.add_subcommand("verify", "Repeat a run's simulator and its stack, and compare every byte");
  command->add_option("run", verify.run, "Run directory")->required();
  command->add_option("--stack", verify.stack,
                      "Command or address of the stack of the second half, which is not started by the scenario of the "
                      "run (default: the built-in stack, if the run had it)");
  command->callback([&] { call.chosen = [&] { return verify_command(call.verify); }; });
}

void add_feed(CLI::App& app, Call& call) {
  FeedOptions& feed = call.feed;
  CLI::App* command =
      app.add_subcommand("feed", "Feed a stack with a run's log or a recorded log, and score its answers");
  command->add_option("input", feed.input, "Run directory, or recorded log (CARMEN, MCAP)")->required();
  command->add_option("--stack", feed.stack,
                      "Command of a stack, or unix:PATH or tcp:127.0.0.1:PORT where it connects (default: built in)");
  command->add_flag("--as-recorded", feed.as_recorded,
                    "Every message of an MCAP log, below /recorded, instead of its scans and odometry");
  command->add_option("--set", feed.overrides, kSetHelp)->take_all();
  command->add_option("--relations", feed.relations, kRelationsHelp);
  command->add_option("--reference", feed.reference, kReferenceHelp);
  add_association(*command, feed.association);
  command->add_option("--out", feed.out, kOutHelp)->capture_default_str();
  command->add_flag("--all", feed.show_all, kAllHelp);
  add_json(*command, feed.form);
  command->callback([&] { call.chosen = [&] { return feed_command(call.feed); }; });
}

void add_stack(CLI::App& app, Call& call) {
  CLI::App* command = app.add_subcommand("stack", "Take part in a run as the built-in stack in another process");
  command->add_option("--connect", call.stack_address,
                      "Address of the simulator, unix:PATH or tcp:HOST:PORT (default: by PATROL_STACK_SOCKET)");
  command->callback([&] { call.chosen = [&] { return stack_command(call.stack_address); }; });
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

}  // namespace

void add_run_commands(CLI::App& app, Call& call) {
  add_run(app, call);
  add_trace(app, call);
  add_bisect(app, call);
  add_score(app, call);
  add_localizability(app, call);
  add_check(app, call);
  add_replay(app, call);
  add_report(app, call);
  add_verify(app, call);
  add_feed(app, call);
  add_stack(app, call);
  add_upload(app, call);
}

}  // namespace patrol::app
