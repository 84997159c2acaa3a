#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/common/process_cost.h"
#include "app/mapping/consistency_report.h"
#include "app/mapping/log_mapping.h"
#include "app/mapping/mapping_page.h"
#include "app/mapping/odometry_report.h"
#include "app/mapping/read_scans.h"
#include "app/mapping/submap_graph_files.h"
#include "app/record/run_directory.h"
#include "core/thread_cpu_time.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "io/json/metrics_json.h"
#include "io/logs/scan_log.h"
#include "io/maps/map_server.h"
#include "io/trajectories/g2o.h"
#include "io/trajectories/tum.h"
#include "io/yaml/settings_yaml.h"
#include "report/page.h"
#include "slam/calibration/calibration.h"
#include "slam/consistency/frozen_scans.h"
#include "slam/consistency/map_consistency.h"
#include "slam/consistency/odometry_check.h"
#include "slam/consistency/unsupported_path.h"
#include "slam/planar_scan.h"

namespace patrol::app {
namespace {

const OutputKind kMapping = {.name = "mapping of a log",
                             .marker_text = "The log is not completely mapped.",
                             .outputs = {"estimate.tum", "odometry.tum", "map.yaml", "map.pgm", "pose_graph.g2o",
                                         "submaps.csv", "keyframes.mcap", "performance.csv", "metrics.json",
                                         "settings.yaml", "report.html"},
                             .required_file = "settings.yaml",
                             .preserved = {"*.part"}};

/// Computation time by segment of scans, which shows whether it grows with the map.
class CostTable {
 public:
  static constexpr std::size_t kScans = 200;  ///< scans per row of the table

  void add(std::size_t num_scans, double way_m) {
    if (num_scans % kScans != 0) return;
    const double now_s = thread_cpu_time_s();
    table_.rows.push_back({static_cast<double>(num_scans), way_m, 1e3 * (now_s - last_s_) / kScans, peak_memory_mb()});
    last_s_ = now_s;
  }
  const io::Table& table() const { return table_; }

 private:
  io::Table table_{.name = "performance", .columns = {"scans", "way_m", "ms_per_scan", "peak_memory_mb"}, .rows = {}};
  double last_s_ = thread_cpu_time_s();
};

/// Data of the log in addition to the mapper's.
struct MappedLog {
  std::vector<Time> stamps;
  std::vector<Pose2> T_odom_body;  ///< [scan], relative to the first
  double way_m = 0.0;              ///< distance traveled, by odometry
  slam::ConsistencyCheck consistency;
  slam::FrozenScans frozen;
  CostTable cost;

  double duration_s() const { return stamps.empty() ? 0.0 : to_seconds(stamps.back() - stamps.front()); }
};

/// Maps a log; false if interrupted.
bool map_log(io::ScanLog& log, const LogMappingSettings& settings, const std::string& name, slam::Mapper& mapper,
             MappedLog& mapped) {
  InterruptGuard guard;
  ProgressBar bar;
  slam::CalibratedScans calibrated(settings.calibration);
  std::optional<Pose2> T_first_odom, T_odom_last;
  const bool is_whole = read_scans(log, name, guard, bar, [&](RecordedScan& recorded) {
    mapped.frozen.add(recorded);
    calibrated.correct(recorded);
    const LevelScan scan = slam::planar_scan(recorded, settings.scan);
    mapped.consistency.add(scan, mapper.update(scan, recorded.T_odom_body));
    if (!T_first_odom) T_first_odom = recorded.T_odom_body.inverse();
    if (T_odom_last) mapped.way_m += (recorded.T_odom_body.position() - T_odom_last->position()).norm();
    T_odom_last = recorded.T_odom_body;
    mapped.stamps.push_back(recorded.scan.stamp);
    mapped.T_odom_body.push_back(*T_first_odom * recorded.T_odom_body);
    mapped.cost.add(mapped.stamps.size(), mapped.way_m);
  });
  if (!is_whole) return false;
  bar.show(fmt::format("{}  {} scans, final optimization", name, mapped.stamps.size()));
  mapper.finish();
  return !guard.is_interrupted();
}

/// Trajectory with one pose per scan, in the log's order; duplicate stamps are kept.
Trajectory trajectory_of(const std::vector<Time>& stamps, const std::vector<Pose2>& poses) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < stamps.size(); ++i) trajectory.push_back({stamps[i], to_pose3(poses[i])});
  return trajectory;
}

io::Metrics metrics_of(const io::ScanLogSummary& summary, const MappedLog& mapped, const Trajectory& estimate,
                       const PoseGraph& graph) {
  std::size_t num_cross_submap = 0;  // loop closures, and after finish() every keyframe's matches with nearby submaps
  for (const PoseGraphEdge& edge : graph.edges) num_cross_submap += edge.kind == PoseGraphEdge::Kind::kLoop ? 1 : 0;
  std::uint64_t num_skipped = 0;
  for (const auto& [reason, count] : summary.skipped) num_skipped += count;
  return {
      {"log",
       {{"scans", mapped.stamps.size()},
        {"skipped", num_skipped},
        {"duration_s", mapped.duration_s()},
        {"odometry_way_m", mapped.way_m}}},
      {"path", {{"poses", estimate.size()}, {"way_m", planar_length_m(estimate)}}},
      {"graph",
       {{"nodes", graph.T_map_node.size()}, {"edges", graph.edges.size()}, {"cross_submap_edges", num_cross_submap}}}};
}

io::Metrics to_metrics(const std::optional<slam::LoopClosureStatistics>& loops) {
  if (!loops) return nullptr;
  return {{"searched", loops->searched},   {"closed", loops->closed},         {"not_found", loops->not_found},
          {"ambiguous", loops->ambiguous}, {"no_overlap", loops->no_overlap}, {"mismatched", loops->mismatched}};
}

/// Result of locating a session in an earlier map, in one line with its end; empty without an earlier map.
std::string earlier_map_line(const SlamOptions& options, bool is_located, std::size_t num_earlier_nodes,
                             std::size_t num_nodes) {
  if (!options.earlier_map) return "";
  if (!is_located)
    return fmt::format("not located in {}: the map contains this log only\n", options.earlier_map->string());
  return fmt::format("located in {}: {} keyframes, {} of them new\n", options.earlier_map->string(), num_nodes,
                     num_nodes - num_earlier_nodes);
}

}  // namespace

ExitCode slam_command(const SlamOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.method) overrides.push_back("slam.method=" + *options.method);
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  if (options.skip_invalid) overrides.emplace_back("log.skip_invalid=true");
  LogMappingSettings settings;
  if (options.calibration) settings.calibration = io::load_settings<slam::Calibration>(*options.calibration, {});
  io::SettingsReader::read_section({"--set", overrides}, io::parse_overrides(overrides), "", settings);
  const std::filesystem::path file = log_of(options.log);
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, settings.log);
  const std::string adaptation = adapt_to_log(file, settings);
  const std::unique_ptr<slam::Mapper> mapper = make_log_mapper(settings);
  std::size_t num_earlier_nodes = 0;
  if (options.earlier_map) {
    if (std::filesystem::weakly_canonical(*options.earlier_map) == std::filesystem::weakly_canonical(options.out))
      throw InputError("--out: must not be the directory of --map");
    const slam::SubmapGraph earlier = load_submap_graph(*options.earlier_map);
    num_earlier_nodes = earlier.keyframes.size();
    if (!mapper->extend(earlier))
      throw InputError(fmt::format("--map: method {} cannot extend a map", settings.slam.method));
  }

  const double wall_s = wall_seconds(), thread_s = thread_cpu_time_s();
  MappedLog mapped;
  const bool is_whole = map_log(*log, settings, file.filename().string(), *mapper, mapped);
  const OutputLock lock = begin_output(options.out, kMapping);  // not earlier: a damaged log must leave no output
  if (!is_whole) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  const std::vector<Pose2> path = mapper->path();
  const Trajectory estimate = trajectory_of(mapped.stamps, path);
  const std::optional<slam::SubmapGraph> submaps = mapper->submap_graph();
  const PoseGraph graph = submaps ? submaps->graph : mapper->graph();
  if (!mapper->is_located()) num_earlier_nodes = 0;
  io::save_tum(options.out / "estimate.tum", estimate, "T_map_body by " + settings.slam.method);
  io::save_tum(options.out / "odometry.tum", trajectory_of(mapped.stamps, mapped.T_odom_body),
               "T_odom_body, from the first scan");
  const OccupancyGrid map = mapper->map();
  io::save_map(options.out / "map.yaml", map);
  if (submaps) save_submap_graph(options.out, *submaps);
  else io::save_g2o(options.out / "pose_graph.g2o", graph);
  io::save_settings(options.out / "settings.yaml", settings);
  io::save_csv(options.out / "performance.csv", mapped.cost.table());
  io::Metrics metrics = metrics_of(log->summary(), mapped, estimate, graph);
  metrics["log"]["range_std_m"] = settings.range_std_m;
  std::vector<slam::UnmatchedSegment> frozen = mapped.frozen.find(path);
  const OdometryReport odometry{.health = slam::check_odometry(mapped.T_odom_body, path, mapped.stamps),
                                .stamps = mapped.stamps,
                                .num_frozen_scans = slam::num_scans_of(frozen)};
  std::vector<slam::Keyframe> earlier;
  if (submaps)
    earlier.assign(submaps->keyframes.begin(),
                   submaps->keyframes.begin() + static_cast<std::ptrdiff_t>(num_earlier_nodes));
  ConsistencyReport consistency{.consistency = mapped.consistency.check(path, earlier), .stamps = mapped.stamps};
  consistency.consistency.frozen = std::move(frozen);
  std::vector<slam::UnsupportedPath>& unsupported = consistency.consistency.unsupported;
  unsupported =
      slam::find_unsupported_path(consistency.consistency.unmatched_segments, odometry.health.faulty, mapped.stamps);
  std::ranges::copy(slam::find_unsupported_gaps(mapped.T_odom_body, path, mapped.stamps),
                    std::back_inserter(unsupported));
  const double took_s = wall_seconds() - wall_s;
  metrics["performance"] = {{"wall_s", took_s},
                            {"processor_s", thread_cpu_time_s() - thread_s},
                            {"real_time_factor", mapped.duration_s() / std::max(1e-9, took_s)},
                            {"peak_memory_mb", peak_memory_mb()}};
  metrics["loop_closures"] = to_metrics(mapper->loop_closure_statistics());
  metrics["earlier_map"] =
      options.earlier_map ? io::Metrics{{"located", mapper->is_located()}, {"nodes", num_earlier_nodes}} : nullptr;
  metrics["consistency"] = consistency.metrics();
  metrics["odometry"] = odometry.metrics();
  io::save_metrics(options.out / "metrics.json", metrics);
  const MappingContents contents{.log = file.filename().string(),
                                 .method = settings.slam.method,
                                 .map = map,
                                 .estimate = estimate,
                                 .cost = mapped.cost.table(),
                                 .metrics = metrics,
                                 .consistency = consistency,
                                 .odometry = odometry};
  io::save_text(options.out / "report.html", report::to_html(mapping_page(contents)));
  complete_output(options.out);

  const std::string text = fmt::format(
      "{}{}{} scans, {:.0f} m by odometry, mapped by {} in {:.1f} s ({:.0f} times real time), {:.0f} MB\n{} keyframes, "
      "{} edges, {} of them to other submaps\n{}{}\n{}\n{}\n",
      io::to_text(log->summary()), adaptation, mapped.stamps.size(), mapped.way_m, settings.slam.method, took_s,
      mapped.duration_s() / std::max(1e-9, took_s), peak_memory_mb(), graph.T_map_node.size(), graph.edges.size(),
      metrics["graph"]["cross_submap_edges"].get<std::size_t>(),
      earlier_map_line(options, mapper->is_located(), num_earlier_nodes, graph.T_map_node.size()), consistency.line(),
      odometry.line(), (options.out / "map.yaml").string());
  print_result(options.form, text, metrics);
  return ExitCode::kDone;
}

}  // namespace patrol::app
