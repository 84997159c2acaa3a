#include "app/study/pipeline_mapper.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/thread_cpu_time.h"
#include "io/logs/run_log.h"

namespace patrol::app {
namespace {

stack::StackSettings without_delay(stack::StackSettings settings) {
  settings.slam_delay_s = 0.0;
  return settings;
}

}  // namespace

PipelineMapper::PipelineMapper(const stack::StackSettings& settings, const RobotDescription& robot, std::uint64_t seed)
    : pipeline_(without_delay(settings), robot, {}, {}, seed) {}

void PipelineMapper::map(const std::filesystem::path& log_mcap) {
  io::LogHandlers handlers;
  handlers.on<Imu>([&](Time, const Imu& imu) { pipeline_.add(imu, output_); });
  handlers.on<JointState>([&](Time, const JointState& constraints) { pipeline_.add(constraints, output_); });
  handlers.on<FootContacts>([&](Time, const FootContacts& contacts) { pipeline_.add(contacts, output_); });
  handlers.on<TrackTicks>([&](Time, const TrackTicks& ticks) { pipeline_.add(ticks, output_); });
  handlers.on<LaserScan>([&](Time, const LaserScan& scan) { handle(scan); });
  io::read_run_log(log_mcap, handlers);
  if (T_map_body_.empty()) throw InputError(fmt::format("{}: no scan could be mapped", log_mcap.string()));
}

void PipelineMapper::handle(const LaserScan& raw) {
  pipeline_.update_odometry();
  const std::optional<LevelScan> scan = pipeline_.level(raw, output_);
  if (!scan) return;
  const double start_s = thread_cpu_time_s();
  const stack::ScanPose pose = pipeline_.localize(*scan, scan->stamp, output_);
  seconds_ += thread_cpu_time_s() - start_s;
  T_map_body_.push_back({.stamp = scan->stamp, .pose = to_pose3(pose.T_map_body)});
  output_.take_messages();
}

}  // namespace patrol::app
