#include "app/cli/command_options.h"

namespace patrol::app {
namespace {

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

void add_site_options(CLI::App& command, LogOnSiteOptions& options) {
  command.add_option("--site", options.site, "Site: MJCF file or name of a world (default: the world of a run)");
  command.add_option("--trajectory", options.trajectory,
                     "Path of the body in the site: TUM file, or truth or pose of a run (default: truth of a run)");
  command.add_option("--lidar", options.lidar,
                     "Simulated lidar: preset, or preset file (default: that of a run, or rplidar_s2)");
}

void add_realism(CLI::App& app, Call& call) {
  RealismOptions& realism = call.realism;
  CLI::App* command = app.add_subcommand("realism", "Compare recorded scans with simulated ones in a site");
  command->add_option("log", realism.input.log, kLogHelp)->required();
  add_site_options(*command, realism.input);
  command->add_option("--set", realism.overrides, kSetHelp)->take_all();
  command->add_flag("--skip-invalid", realism.skip_invalid, kSkipHelp);
  command->add_option("--out", realism.out, kOutHelp)->capture_default_str();
  add_json(*command, realism.form);
  command->callback([&] { call.chosen = [&] { return realism_command(call.realism); }; });
}

void add_calibrate(CLI::App& app, Call& call) {
  CalibrateOptions& calibrate = call.calibrate;
  CLI::App* command = app.add_subcommand("calibrate", "Calibrate odometry, lidar pose or lidar settings from a log");
  command->add_option("log", calibrate.log, kLogHelp)->required();
  command
      ->add_option("--sensor", calibrate.sensor,
                   "odometry: lidar pose and odometry scales; lidar: noise and other settings of the lidar, in a site")
      ->check(CLI::IsMember({"odometry", "lidar"}))
      ->capture_default_str();
  add_site_options(*command, calibrate.site);
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

}  // namespace

void add_mapping_commands(CLI::App& app, Call& call) {
  add_slam(app, call);
  add_calibrate(app, call);
  add_realism(app, call);
  add_train(app, call);
  add_solve(app, call);
  add_plan(app, call);
}

}  // namespace patrol::app
