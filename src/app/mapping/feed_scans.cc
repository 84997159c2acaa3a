#include "app/mapping/feed_scans.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/mapping/log_documents.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "link/link_error.h"

namespace patrol::app {
namespace {

// A log states the pose of the lidar for every scan, with rounding errors.
constexpr double kMountTolerance_m = 0.005;
const double kMountTolerance_rad = to_rad(0.5);

void check_mount(const Pose2& T_body_lidar, const RecordedScan& recorded, const std::string& file) {
  const Pose2 difference = T_body_lidar.inverse() * recorded.T_body_lidar;
  if (difference.position().norm() <= kMountTolerance_m && std::abs(difference.yaw) <= kMountTolerance_rad) return;
  throw InputError(
      fmt::format("{}: the lidar has another pose on the body at {:.3f} s: a stack is fed with one lidar: choose its "
                  "scans with --set log.scan_topic or log.carmen_laser",
                  file, to_seconds(recorded.scan.stamp)));
}

/// Delivers a scan at its end, after the odometry of its first beam and, if the beams have times, of its last one.
void deliver(LogFeeder& feeder, const RecordedScan& recorded) {
  const Time end = io::last_beam(recorded.scan);
  feeder.advance(end);
  feeder.deliver(RecordedOdometry{.stamp = recorded.scan.stamp, .T_odom_body = recorded.T_odom_body});
  if (end > recorded.scan.stamp)
    feeder.deliver(RecordedOdometry{.stamp = end, .T_odom_body = recorded.T_odom_body * recorded.T_begin_end});
  feeder.deliver(recorded.scan);
}

}  // namespace

void check_scans(io::ScanLog& log, const std::string& file) {
  std::optional<Pose2> T_body_lidar;
  while (const std::optional<RecordedScan> recorded = log.next()) {
    if (!T_body_lidar) T_body_lidar = recorded->T_body_lidar;
    check_mount(*T_body_lidar, *recorded, file);
  }
}

FedAnswers feed_scans(io::ScanLog& log, const std::string& name, const MakeStack& make_stack,
                      const std::function<void()>& begin, const std::filesystem::path& log_mcap,
                      const InterruptGuard& guard) {
  const double wall_start_s = wall_seconds(), cpu_start_s = process_seconds();
  ProgressBar bar;
  std::optional<LogFeeder> feeder;
  RunOutcome outcome;
  std::optional<Time> first_stamp;
  try {
    const bool is_whole = read_scans(log, name, guard, bar, [&](const RecordedScan& recorded) {
      if (!feeder) {
        const io::TransformSet mounts = lidar_mount(recorded.T_body_lidar);
        std::unique_ptr<StackPort> stack = make_stack(mounts);
        begin();
        feeder.emplace(std::move(stack), log_mcap, mounts, io::last_beam(recorded.scan));
        first_stamp = recorded.scan.stamp;
      }
      deliver(*feeder, recorded);
      outcome.duration = recorded.scan.stamp - *first_stamp;
    });
    if (is_whole) {
      bar.show(fmt::format("{}  {} scans, last turn", name, log.summary().num_scans));
      feeder->finish();
    }
    if (!is_whole || guard.is_interrupted()) outcome.end = RunEnd::kInterrupted;
  } catch (const link::LinkError& error) {
    if (!feeder) throw;
    set_failure(outcome, error);
  }
  outcome.wall_s = wall_seconds() - wall_start_s;
  outcome.cpu_s = process_seconds() - cpu_start_s;
  return feeder->answers(std::move(outcome));
}

}  // namespace patrol::app
