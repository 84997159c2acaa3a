#include "app/study/mapped_run.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/neighbor_model.h"
#include "core/error.h"
#include "core/thread_cpu_time.h"
#include "io/logs/scan_log.h"
#include "slam/methods/mapper.h"
#include "slam/planar_scan.h"

namespace patrol::app {
namespace {

constexpr std::size_t kScansPerSample = 20;

std::vector<Pose2> true_poses(const Trajectory& T_world_body, const std::vector<Time>& stamps,
                              const std::vector<std::size_t>& scans) {
  std::vector<Pose2> poses;
  for (const std::size_t scan : scans) {
    const std::optional<Pose3> pose = pose_at(T_world_body, stamps[scan]);
    if (!pose)
      throw InputError(fmt::format("ground truth does not cover the scan at {:.3f} s", to_seconds(stamps[scan])));
    poses.push_back(to_pose2(*pose));
  }
  return poses;
}

}  // namespace

MappedRun map_log_of(const StudyRun& run, const std::string& method) {
  slam::MapperSettings settings;
  settings.method = method;
  const BoostedStumps neighbors = load_neighbor_model(method, find_data_root(""));
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(run.log, {});
  // Without it, the antenna beside the lidar is mapped along the path.
  const slam::PlanarScanSettings scan{.min_range_m = run.scenario.stack.scan_leveling.self_filter_radius_m};
  MappedRun mapped;
  std::vector<Time> stamps;
  const double before_mb = heap_mb();
  const auto look = [&] { mapped.memory_mb = std::max(mapped.memory_mb, heap_mb() - before_mb); };
  const std::unique_ptr<slam::Mapper> mapper = slam::make_mapper(settings, neighbors, run.scenario.seed);
  while (const std::optional<RecordedScan> recorded = log->next()) {
    const double start_s = thread_cpu_time_s();
    mapper->update(slam::planar_scan(*recorded, scan), recorded->T_odom_body);
    mapped.seconds += thread_cpu_time_s() - start_s;
    stamps.push_back(recorded->scan.stamp);
    if (stamps.size() % kScansPerSample == 0) look();
  }
  const double start_s = thread_cpu_time_s();
  mapper->finish();
  mapped.map = mapper->map();
  mapped.seconds += thread_cpu_time_s() - start_s;
  look();
  const std::vector<Pose2> path = mapper->path();
  for (std::size_t i = 0; i < path.size(); ++i) mapped.T_map_body.push_back({stamps[i], to_pose3(path[i])});
  mapped.loops =
      evaluate_loop_closures(mapper->graph(), true_poses(run.record.T_world_body, stamps, mapper->node_scan_indices()));
  return mapped;
}

}  // namespace patrol::app
