#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/exit_code.h"
#include "app/monitor/monitor_options.h"
#include "app/plan/plan_options.h"
#include "app/sweep/sweep_options.h"
#include "app/test/test_options.h"
#include "score/relation_error.h"

/// One function per command of the program. They print results to standard output and talk to standard error.
namespace patrol::app {

struct RunOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<std::uint64_t> seed;
  bool watch = false;  ///< show it on the terminal while it goes
  std::optional<std::filesystem::path> out;
  std::optional<std::string> report_to;  ///< address of a monitoring platform
  std::optional<std::filesystem::path> report_token_file;
  std::optional<std::string> robot_name;  ///< for the platform; otherwise robot and seed
};
ExitCode run_command(const RunOptions& options);

/// What `patrol score` was given: a run directory, or two trajectories, or a trajectory and relations, or two maps.
struct ScoreOptions {
  std::filesystem::path run;
  std::filesystem::path estimate;
  std::filesystem::path reference;
  std::filesystem::path relations;
  score::RelationSettings relation_settings;
  std::filesystem::path map;
  std::filesystem::path reference_map;
};
ExitCode score_command(const ScoreOptions& options);

struct LocalizabilityOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  double step_m = 0.5;
  std::filesystem::path out = "out/localizability";
};
/// What one scan can tell, everywhere in a scenario's world.
ExitCode localizability_command(const LocalizabilityOptions& options);

struct ReplayOptions {
  std::filesystem::path run;
  std::string cut = "story";
  std::string camera = "chase";
  double speed = 8.0;
  double slow = 2.0;
  std::string renderer = "auto";
  std::string size = "1280x720";
  std::optional<double> still_s;
  std::optional<std::filesystem::path> out;
};
ExitCode replay_command(const ReplayOptions& options);

struct ReportOptions {
  std::filesystem::path directory;  ///< of a run, a sweep, a budget or a fault matrix
  std::optional<std::filesystem::path> out;
};
ExitCode report_command(const ReportOptions& options);

/// Runs `run` again beside it and compares the logs.
ExitCode verify_command(const std::filesystem::path& run);

/// Runs every variant with every seed, or a shard of them, and compares the variants.
ExitCode sweep_command(const SweepOptions& options);

/// Puts the results of `parts`, of the same sweep, into `root`, and writes the tables when all are there.
ExitCode collect_command(const std::filesystem::path& root, const std::vector<std::filesystem::path>& parts);

/// Takes one imperfection away at a time, and says how much of the errors each owns.
ExitCode budget_command(const BudgetOptions& options);

/// Runs a scenario with every fault that its robot's sensors can have, and says what each led to.
ExitCode faults_command(const FaultsOptions& options);

struct SlamOptions {
  std::filesystem::path log;          ///< CARMEN or MCAP
  std::optional<std::string> method;  ///< slam.method
  std::vector<std::string> overrides;
  std::optional<std::filesystem::path> calibration;  ///< calibration.yaml of `patrol calibrate`
  std::optional<std::uint64_t> seed;
  bool skip_bad_lines = false;
  std::filesystem::path out = "out/slam";
};
/// Maps a recorded log.
ExitCode slam_command(const SlamOptions& options);

struct CalibrateOptions {
  std::filesystem::path log;  ///< CARMEN or MCAP
  std::vector<std::string> overrides;
  bool skip_bad_lines = false;
  std::filesystem::path out = "out/calibration";
};
/// The lidar's place and odometry's scales, from a recorded log alone.
ExitCode calibrate_command(const CalibrateOptions& options);

struct TrainOptions {
  std::vector<std::filesystem::path> runs;      ///< run directories, of which is learnt
  std::vector<std::filesystem::path> held_out;  ///< others, on which what was learnt is tried
  std::vector<std::string> overrides;
  std::filesystem::path out = "submap_neighbours.json";
};
/// Learns to recognise neighbouring submaps (`--method submap_rbpf`).
ExitCode train_command(const TrainOptions& options);

struct SolveOptions {
  std::filesystem::path graph;  ///< g2o
  bool doubts_loops = false;    ///< a robust loss on edges that are not odometry
  std::filesystem::path out = "out/solved.g2o";
};
/// Solves anyone's pose graph.
ExitCode solve_command(const SolveOptions& options);

/// A route, a tour, or every problem of a file, on anybody's map.
ExitCode plan_command(const PlanOptions& options);

struct StudyOptions {
  std::string name;
  std::optional<std::string> seeds;  ///< "N": 1001 ... 1000 + N, on which nothing was tuned; or "A..B"
  int jobs = 0;                      ///< seeds at a time; 0: one for each core
  double seed_limit_s = 3600.0;      ///< wall time of a seed
  std::filesystem::path out = "out/study";
};
/// A paper's experiment, its published figures beside ours.
ExitCode study_command(const StudyOptions& options);

/// Runs every scenario of a folder against what it expects.
ExitCode test_command(const TestOptions& options);

/// The monitoring platform, until it is interrupted.
ExitCode monitor_command(const MonitorOptions& options);

struct SendOptions {
  std::filesystem::path run;
  std::string to;
  std::optional<std::filesystem::path> token_file;
  double limit_s = 30.0;  ///< without any progress
};
/// Sends what of a run's results still waits for the platform.
ExitCode send_command(const SendOptions& options);

ExitCode list_command();

}  // namespace patrol::app
