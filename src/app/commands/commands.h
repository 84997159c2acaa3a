#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/campaign/sweep/sweep_options.h"
#include "app/campaign/test/test_options.h"
#include "app/common/exit_code.h"
#include "app/common/print_result.h"
#include "app/monitor/monitor_options.h"
#include "app/plan/plan_options.h"
#include "app/realism/log_on_site.h"
#include "score/pose/relation_error.h"
#include "score/pose/trajectory_error.h"

/// Functions of the program's commands, one each. Results are printed to standard output, messages to standard error.
namespace patrol::app {

struct RunOptions {
  std::filesystem::path scenario;      ///< scenario file, or a folder of worlds for a run with goals
  std::vector<std::string> goals;      ///< "X,Y" or "X,Y,DEG" in the site: a tour instead of the scenario's mission
  std::string start;                   ///< start of the tour, in the same form; empty: that of the scenario
  std::optional<std::string> robot;    ///< robot instead of that of the scenario
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<std::uint64_t> seed;
  std::optional<std::string> stack;  ///< command or address of a stack instead of that of the scenario
  bool watch = false;                ///< show live status in the terminal
  std::optional<int> threads;        ///< threads of the simulation, 1 or 2; default: 2 on several cores
  double snapshot_period_s = 0.0;    ///< simulated time between two snapshots; 0: none
  std::string from;                  ///< "RUN@SECONDS": branch of that run instead of a run of `scenario`
  std::optional<std::filesystem::path> out;
  std::optional<std::string> monitor_url;  ///< URL of a monitoring server
  std::optional<std::filesystem::path> monitor_token_file;
  std::optional<std::string> robot_name;  ///< name shown by the monitoring server; default: robot and seed
  bool show_all = false;                  ///< print every metric
  ResultForm form = ResultForm::kText;
};
ExitCode run_command(const RunOptions& options);

/// Input of `patrol trace`: a part of a run.
struct TraceOptions {
  std::filesystem::path run;
  double from_s = 0.0;
  double to_s = 0.0;
};
/// Prints a line with hashes of the state for every tick.
ExitCode trace_command(const TraceOptions& options);

/// Input of `patrol bisect`: two runs, each with the program that made it; this one without.
struct BisectOptions {
  std::filesystem::path a, b;
  std::optional<std::string> program_a, program_b;
  ResultForm form = ResultForm::kText;
};
ExitCode bisect_command(const BisectOptions& options);

/// Assignment of the poses of an estimate to the stamps of a reference.
struct AssociationOptions {
  std::optional<double> max_dt_s;  ///< default: that of RelationSettings, of a reference score::kMaxAlignedDt
  double reference_x_m = 0.0;      ///< x of the reference point of relations in the body frame

  bool is_given() const { return max_dt_s || reference_x_m != 0.0; }
  score::RelationSettings of_relations() const {
    score::RelationSettings settings{.reference_x_m = reference_x_m};
    if (max_dt_s) settings.max_dt_s = *max_dt_s;
    return settings;
  }
  Time of_reference() const { return max_dt_s ? from_seconds(*max_dt_s) : score::kMaxAlignedDt; }
};

/// Input of `patrol score`: a run directory, or an estimate with a reference trajectory, relations or both, two maps,
/// or an estimate and maps.
struct ScoreOptions {
  std::filesystem::path run;
  std::filesystem::path estimate;
  std::filesystem::path reference;
  std::filesystem::path relations;
  AssociationOptions association;
  std::filesystem::path map;
  std::filesystem::path reference_map;
  bool show_all = false;  ///< print every metric of a run
  ResultForm form = ResultForm::kText;
};
ExitCode score_command(const ScoreOptions& options);

struct LocalizabilityOptions {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;
  double grid_step_m = 0.5;
  std::filesystem::path out = "out/localizability";
};
/// Maps the accuracy bound of a single scan over a scenario's world.
ExitCode localizability_command(const LocalizabilityOptions& options);

struct CheckOptions {
  std::string robot;  ///< name of a folder of `models`
  std::vector<std::string> overrides;
  std::optional<std::uint64_t> seed;
  std::filesystem::path out = "out/check";
  std::optional<std::filesystem::path> mjcf;  ///< file for the model of the robot, which is not driven then
  ResultForm form = ResultForm::kText;
};
/// Drives a robot through the maneuvers of a check (app/check) and writes the verdict.
ExitCode check_command(const CheckOptions& options);

struct ReplayOptions {
  std::filesystem::path run;
  std::string style = "highlights";
  std::string camera = "chase";
  double speed = 8.0;
  double highlight_speed = 2.0;
  double frames_per_second = 30.0;
  int jobs = 0;  ///< processes; 0: one per core
  std::string renderer = "auto";
  std::string size = "1280x720";
  std::optional<double> still_s;
  std::optional<std::filesystem::path> out;
};
ExitCode replay_command(const ReplayOptions& options);

struct ReportOptions {
  std::filesystem::path directory;  ///< directory of a run, a sweep, an error budget or a fault matrix
  std::optional<std::filesystem::path> out;
};
ExitCode report_command(const ReportOptions& options);

struct VerifyOptions {
  std::filesystem::path run;
  std::optional<std::string> stack;  ///< command or address of the stack; a run with the built-in stack needs none
};
/// Repeats the two halves of a run in a temporary directory and compares the logs: the simulator with the recorded
/// answers of the stack, and the stack with the recorded messages of the simulator.
ExitCode verify_command(const VerifyOptions& options);

struct FeedOptions {
  std::filesystem::path input;       ///< run directory, or recorded log (CARMEN or MCAP)
  std::optional<std::string> stack;  ///< command or address of the stack; default: the built-in one
  bool as_recorded = false;          ///< deliver every message of an MCAP log instead of its scans and odometry
  std::vector<std::string> overrides;
  std::filesystem::path relations;  ///< reference relations of a recorded log; empty: none
  std::filesystem::path reference;  ///< reference trajectory of a recorded log; empty: none
  AssociationOptions association;
  std::filesystem::path out = "out/feed";
  bool show_all = false;  ///< print every metric
  ResultForm form = ResultForm::kText;
};
/// Feeds a stack with the log of a run, or with the scans and the odometry or all messages of a recorded log, and
/// scores its answers, which have no effect on the robot.
ExitCode feed_command(const FeedOptions& options);
/// `feed_command` for a recorded log.
ExitCode feed_log_command(const FeedOptions& options);

/// Takes part in a run as the built-in stack in a process of its own. `address`: of the simulator; none: as the process
/// that `patrol run --stack` starts.
ExitCode stack_command(const std::optional<std::string>& address);

/// Runs every variant with every seed, or one shard of these runs, and compares the variants.
ExitCode sweep_command(const SweepOptions& options);

struct MergeOptions {
  std::filesystem::path root;                ///< directory of the sweep
  std::vector<std::filesystem::path> parts;  ///< directories of its shards
  ResultForm form = ResultForm::kText;
};
/// Copies the results of the shards of one sweep to its directory, and writes the tables if all runs are complete.
ExitCode merge_command(const MergeOptions& options);

/// Computes an error budget: reruns the scenario with one error source removed at a time.
ExitCode error_budget_command(const ErrorBudgetOptions& options);

/// Runs a scenario with every fault of every sensor and classifies the outcomes.
ExitCode fault_matrix_command(const FaultMatrixOptions& options);

struct SlamOptions {
  std::filesystem::path log;          ///< CARMEN or MCAP
  std::optional<std::string> method;  ///< slam.method
  std::vector<std::string> overrides;
  std::optional<std::filesystem::path> calibration;  ///< calibration.yaml of `patrol calibrate`
  std::optional<std::filesystem::path> earlier_map;  ///< directory of an earlier `patrol slam`, whose map is extended
  std::optional<std::uint64_t> seed;
  bool skip_invalid = false;
  std::filesystem::path out = "out/slam";
  ResultForm form = ResultForm::kText;
};
/// Builds a map from a recorded log.
ExitCode slam_command(const SlamOptions& options);

struct RealismOptions {
  LogOnSiteOptions input;
  std::vector<std::string> overrides;
  bool skip_invalid = false;
  std::filesystem::path out = "out/realism";
  ResultForm form = ResultForm::kText;
};
/// Compares the recorded scans of a log with simulated ones in a site.
ExitCode realism_command(const RealismOptions& options);

struct CalibrateOptions {
  std::filesystem::path log;        ///< CARMEN or MCAP
  std::string sensor = "odometry";  ///< odometry: lidar pose and odometry scales; lidar: settings of the lidar
  LogOnSiteOptions site;            ///< site, path and lidar for the sensor lidar
  std::vector<std::string> overrides;
  bool skip_invalid = false;
  std::filesystem::path out = "out/calibration";
  ResultForm form = ResultForm::kText;
};
/// Calibrates the lidar pose and the odometry scales, or the settings of the lidar, from a recorded log.
ExitCode calibrate_command(const CalibrateOptions& options);
/// Fits the settings of the lidar to a log in a known site.
ExitCode calibrate_lidar_command(const CalibrateOptions& options);

struct TrainOptions {
  std::vector<std::filesystem::path> runs;        ///< run directories for training
  std::vector<std::filesystem::path> validation;  ///< run directories for validation
  std::vector<std::string> overrides;
  std::filesystem::path out = "submap_neighbors.json";
  ResultForm form = ResultForm::kText;
};
/// Trains the classifier of neighboring submaps (`--method submap_rbpf`).
ExitCode train_command(const TrainOptions& options);

struct ImportRobotOptions {
  std::filesystem::path file;                ///< .urdf or .xacro
  std::vector<std::string> packages;         ///< NAME=FOLDER of package:// and $(find NAME)
  std::vector<std::string> xacro_arguments;  ///< NAME=VALUE
  std::vector<std::string> frames;           ///< FRAME=LINK: sensor frames of Patrol
  std::string base_link;
  std::vector<std::string> casters;  ///< links
  std::string forward;               ///< direction of travel in the base link
  std::string drive;
  std::filesystem::path out;  ///< folder models/NAME
};
/// Makes a robot of `models` from a robot description.
ExitCode import_robot_command(const ImportRobotOptions& options);

struct ImportSiteOptions {
  std::filesystem::path file;                ///< floor plan, mesh, SDF world or MJCF
  std::filesystem::path out;                 ///< folder worlds/NAME
  std::vector<std::string> packages;         ///< NAME=FOLDER
  std::vector<std::string> xacro_arguments;  ///< NAME=VALUE
  std::vector<std::string> without;          ///< models of an SDF world to leave out
  double wall_height_m = 2.5;
  double scale = 0.0;              ///< meters per unit of the file; 0: by rule
  std::string up;                  ///< axis of the file that points up; empty: by rule
  std::filesystem::path stations;  ///< CSV of stations; empty: none
  int random_stations = 0;
  std::uint64_t seed = 1;
  std::string start;  ///< "X,Y" or "X,Y,DEG"; empty: by rule
  std::string robot = "wheeled";
  double contact_cell_m = 0.05;    ///< cell of the contact geometry of meshes
  std::vector<std::string> given;  ///< options on the command line, such as "--scale"
};
/// Makes a site of `worlds` from a file.
ExitCode import_site_command(const ImportSiteOptions& options);

struct SiteOptions {
  std::string world;  ///< name of a folder of `worlds`
  ResultForm form = ResultForm::kText;
};
/// Reports the surfaces of a site: ground, walls and obstacles.
ExitCode site_command(const SiteOptions& options);

struct GenerateOptions {
  std::uint64_t number = 1;  ///< number of the first course
  int count = 1;
  std::string robot = "wheeled";
  std::filesystem::path out = "worlds";  ///< folder that receives a folder for each course
};
/// Generates obstacle courses for a robot as sites.
ExitCode generate_command(const GenerateOptions& options);

struct SolveOptions {
  std::filesystem::path graph;        ///< g2o
  bool robust_loop_closures = false;  ///< robust loss on edges that are not odometry
  std::filesystem::path out = "out/solved.g2o";
};
/// Optimizes a pose graph.
ExitCode solve_command(const SolveOptions& options);

/// Plans a path, a station order, or every problem of a benchmark file.
ExitCode plan_command(const PlanOptions& options);

struct StudyOptions {
  std::string name;
  std::optional<std::string> seeds;  ///< "N": 1001 ... 1000 + N, which were not used for tuning; or "A..B"
  int jobs = 0;                      ///< parallel seeds; 0: one per core
  double seed_timeout_s = 3600.0;    ///< wall-clock limit per seed
  std::filesystem::path out = "out/study";
  ResultForm form = ResultForm::kText;
};
/// Reproduces a published experiment and compares the results.
ExitCode study_command(const StudyOptions& options);

/// Runs every scenario of a folder and checks its expectations.
ExitCode test_command(const TestOptions& options);
/// Proposes expectations from several seeds of every scenario: `patrol test --calibrate`.
ExitCode test_calibration_command(const TestOptions& options);

/// Runs the monitoring server until it is interrupted.
ExitCode monitor_command(const MonitorOptions& options);

struct UploadOptions {
  std::filesystem::path run;
  std::string monitor_url;
  std::optional<std::filesystem::path> token_file;
  double timeout_s = 30.0;  ///< timeout without progress
};
/// Uploads the pending results of a run to the monitoring server.
ExitCode upload_command(const UploadOptions& options);

struct ListOptions {
  std::optional<std::string> section;  ///< name of the section to print; all sections if not given
  ResultForm form = ResultForm::kText;
};
ExitCode list_command(const ListOptions& options);

}  // namespace patrol::app
