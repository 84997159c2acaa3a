#include "app/record/run_record.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/logs/run_log.h"

namespace patrol::app {
namespace {

/// Appends a pose; stamps must increase, so a repeated or late message is ignored.
void append(Trajectory& trajectory, Time stamp, const Pose3& pose) {
  if (trajectory.empty() || stamp > trajectory.back().stamp) trajectory.push_back({stamp, pose});
}

}  // namespace

RunRecord read_run_record(const std::filesystem::path& log_mcap) {
  RunRecord record;
  io::LogHandlers handlers;
  handlers.on<UwbPoseEstimate>([&](Time, const UwbPoseEstimate& pose) {
    append(record.T_map_body_by_ranges, pose.stamp, to_pose3(pose.T_map_body));
  });
  handlers.on<PoseEstimate>([&](Time, const PoseEstimate& pose) {
    append(record.T_map_body, pose.stamp, to_pose3(pose.T_map_body));
    if (record.covariances.size() < record.T_map_body.size()) record.covariances.push_back(pose.covariance);
  });
  handlers.on<SiteRegistration>(
      [&](Time, const SiteRegistration& registration) { record.registrations.push_back(registration); });
  handlers.on<OdometryEstimate>([&](Time, const OdometryEstimate& odometry) {
    append(record.T_odom_body, odometry.stamp, odometry.T_odom_body);
  });
  handlers.on<GroundTruth>(
      [&](Time, const GroundTruth& truth) { append(record.T_world_body, truth.stamp, truth.T_world_body); });
  handlers.on<Event>([&](Time, const Event& event) { record.events.push_back(event); });
  handlers.on<Path>([&](Time, const Path&) { ++record.num_paths; });
  handlers.on<Collision>([&](Time, const Collision& collision) { record.collisions.push_back(collision); });
  handlers.on<LocalizationConfidence>(
      [&](Time, const LocalizationConfidence& confidence) { record.confidences.push_back(confidence); });
  handlers.on<TeleopCommand>([&](Time, const TeleopCommand& command) { record.teleop.push_back(command); });
  handlers.on<LiningResult>([&](Time, const LiningResult& result) { record.linings.push_back(result); });
  handlers.on<WaterResult>([&](Time, const WaterResult& result) { record.waters.push_back(result); });
  handlers.on<MapUpdate>([&](Time, const MapUpdate& update) { record.map = update.map; });
  record.is_complete = io::read_run_log(log_mcap, handlers);
  if (record.T_world_body.empty()) throw InputError(fmt::format("{}: contains no ground truth", log_mcap.string()));
  return record;
}

}  // namespace patrol::app
