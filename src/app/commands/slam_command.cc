#include <algorithm>
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
#include "app/mapping/log_mapping.h"
#include "app/mapping/mapped_log.h"
#include "app/mapping/mapping_page.h"
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

namespace patrol::app {
namespace {

const OutputKind kMapping = {.name = "mapping of a log",
                             .marker_text = "The log is not completely mapped.",
                             .outputs = {"estimate.tum", "odometry.tum", "map.yaml", "map.pgm", "pose_graph.g2o",
                                         "submaps.csv", "keyframes.mcap", "performance.csv", "metrics.json",
                                         "settings.yaml", "report.html"},
                             .required_file = "settings.yaml",
                             .preserved = {"*.part"}};

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
        {"odometry_way_m", mapped.distance_m}}},
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

LogMappingSettings settings_of(const SlamOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.method) overrides.push_back("slam.method=" + *options.method);
  if (options.seed) overrides.push_back(fmt::format("seed={}", *options.seed));
  if (options.skip_invalid) overrides.emplace_back("log.skip_invalid=true");
  LogMappingSettings settings;
  if (options.calibration) settings.calibration = io::load_settings<slam::Calibration>(*options.calibration, {});
  io::SettingsReader::read_section({"--set", overrides}, io::parse_overrides(overrides), "", settings);
  return settings;
}

/// Extends a mapper with the map of an earlier session. Returns the number of its keyframes; 0 without an earlier map.
std::size_t extend_earlier_map(const SlamOptions& options, const std::string& method, slam::Mapper& mapper) {
  if (!options.earlier_map) return 0;
  if (std::filesystem::weakly_canonical(*options.earlier_map) == std::filesystem::weakly_canonical(options.out))
    throw InputError("--out: must not be the directory of --map");
  const slam::SubmapGraph earlier = load_submap_graph(*options.earlier_map);
  if (!mapper.extend(earlier)) throw InputError(fmt::format("--map: method {} cannot extend a map", method));
  return earlier.keyframes.size();
}

/// Returns the first keyframes of a map, those of earlier sessions.
std::vector<slam::Keyframe> earlier_keyframes(const std::optional<slam::SubmapGraph>& submaps, std::size_t count) {
  if (!submaps) return {};
  return {submaps->keyframes.begin(), submaps->keyframes.begin() + static_cast<std::ptrdiff_t>(count)};
}

}  // namespace

ExitCode slam_command(const SlamOptions& options) {
  LogMappingSettings settings = settings_of(options);
  const std::filesystem::path file = log_of(options.log);
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(file, settings.log);
  const std::string adaptation = adapt_to_log(file, settings);
  const std::unique_ptr<slam::Mapper> mapper = make_log_mapper(settings);
  std::size_t num_earlier_nodes = extend_earlier_map(options, settings.slam.method, *mapper);

  const double wall_s = wall_seconds(), thread_s = thread_cpu_time_s();
  MappedLog mapped;
  const bool is_whole = map_log(*log, settings, file.filename().string(), *mapper, mapped);
  const OutputLock lock = begin_output(options.out, kMapping);  // not earlier: a damaged log must leave no output
  if (!is_whole) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  if (!mapper->is_located()) num_earlier_nodes = 0;
  const std::vector<Pose2> path = mapper->path();
  const Trajectory estimate = trajectory_of(mapped.stamps, path);
  const std::optional<slam::SubmapGraph> submaps = mapper->submap_graph();
  const PoseGraph graph = submaps ? submaps->graph : mapper->graph();
  const OccupancyGrid map = mapper->map();
  io::save_tum(options.out / "estimate.tum", estimate, "T_map_body by " + settings.slam.method);
  io::save_tum(options.out / "odometry.tum", trajectory_of(mapped.stamps, mapped.T_odom_body),
               "T_odom_body, from the first scan");
  io::save_map(options.out / "map.yaml", map);
  if (submaps) save_submap_graph(options.out, *submaps);
  else io::save_g2o(options.out / "pose_graph.g2o", graph);
  io::save_settings(options.out / "settings.yaml", settings);
  io::save_csv(options.out / "performance.csv", mapped.cost.table());

  const MappingChecks checks = check_mapping(mapped, path, earlier_keyframes(submaps, num_earlier_nodes));
  const double took_s = wall_seconds() - wall_s, real_time_factor = mapped.duration_s() / std::max(1e-9, took_s);
  io::Metrics metrics = metrics_of(log->summary(), mapped, estimate, graph);
  metrics["log"]["range_std_m"] = settings.range_std_m;
  metrics["performance"] = {{"wall_s", took_s},
                            {"processor_s", thread_cpu_time_s() - thread_s},
                            {"real_time_factor", real_time_factor},
                            {"peak_memory_mb", peak_memory_mb()}};
  metrics["loop_closures"] = to_metrics(mapper->loop_closure_statistics());
  metrics["earlier_map"] =
      options.earlier_map ? io::Metrics{{"located", mapper->is_located()}, {"nodes", num_earlier_nodes}} : nullptr;
  metrics["consistency"] = checks.consistency.metrics();
  metrics["odometry"] = checks.odometry.metrics();
  io::save_metrics(options.out / "metrics.json", metrics);
  const MappingContents contents{.log = file.filename().string(),
                                 .method = settings.slam.method,
                                 .map = map,
                                 .estimate = estimate,
                                 .cost = mapped.cost.table(),
                                 .metrics = metrics,
                                 .consistency = checks.consistency,
                                 .odometry = checks.odometry};
  io::save_text(options.out / "report.html", report::to_html(mapping_page(contents)));
  complete_output(options.out);

  const std::string text = fmt::format(
      "{}{}{} scans, {:.0f} m by odometry, mapped by {} in {:.1f} s ({:.0f} times real time), {:.0f} MB\n{} keyframes, "
      "{} edges, {} of them to other submaps\n{}{}\n{}\n{}\n",
      io::to_text(log->summary()), adaptation, mapped.stamps.size(), mapped.distance_m, settings.slam.method, took_s,
      real_time_factor, peak_memory_mb(), graph.T_map_node.size(), graph.edges.size(),
      metrics["graph"]["cross_submap_edges"].get<std::size_t>(),
      earlier_map_line(options, mapper->is_located(), num_earlier_nodes, graph.T_map_node.size()),
      checks.consistency.line(), checks.odometry.line(), (options.out / "map.yaml").string());
  print_result(options.form, text, metrics);
  return ExitCode::kDone;
}

}  // namespace patrol::app
