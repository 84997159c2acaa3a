#include "app/mapping/submap_track.h"

#include <memory>

#include <fmt/format.h>

#include "app/record/run_directory.h"
#include "core/error.h"
#include "core/trajectory.h"
#include "io/logs/scan_log.h"
#include "io/trajectories/tum.h"

namespace patrol::app {

std::optional<SubmapTrack> build_submaps(const std::filesystem::path& run, const slam::PlanarScanSettings& scan,
                                         const slam::SubmapRbpfSettings& settings, const BoostedStumps& neighbors,
                                         std::uint64_t seed, ProgressBar& bar, const InterruptGuard& guard) {
  const RunDirectory directory = open_run_directory(run);
  const Trajectory T_world_body = io::load_tum(directory.truth());
  const std::unique_ptr<io::ScanLog> log = io::open_scan_log(directory.log(), {});
  SubmapTrack track{.slam = slam::SubmapRbpf(settings, neighbors, seed)};
  while (const std::optional<RecordedScan> recorded = log->next()) {
    if (guard.is_interrupted()) return std::nullopt;
    track.slam.update(slam::planar_scan(*recorded, scan), recorded->T_odom_body);
    track.stamps.push_back(recorded->scan.stamp);
    bar.show(fmt::format("{}  {:3.0f} %  {} submaps", run.string(), 100.0 * log->progress(),
                         track.slam.first_scans().size()),
             log->progress());
  }
  track.slam.finish();
  for (const std::size_t first : track.slam.first_scans()) {
    const std::optional<Pose3> pose = pose_at(T_world_body, track.stamps[first]);
    if (!pose) throw InputError(fmt::format("{}: does not cover the scans of the log", directory.truth().string()));
    track.T_world_submap.push_back(to_pose2(*pose));
  }
  return track;
}

}  // namespace patrol::app
