#include "app/record/run_record.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "io/logs/run_log.h"
#include "score/pose/trajectory_error.h"

namespace patrol::app {
namespace {

/// Appends a pose; stamps must increase, so a repeated or late message is ignored. Returns whether it was appended.
bool append(Trajectory& trajectory, Time stamp, const Pose3& pose) {
  if (!trajectory.empty() && stamp <= trajectory.back().stamp) return false;
  trajectory.push_back({stamp, pose});
  return true;
}

/// Sorts messages by stamp: the stamps of a stack in another process need not increase. Messages with equal stamps stay
/// in order of receipt.
template <typename Message>
void sort_by_stamp(std::vector<Message>& messages) {
  std::ranges::stable_sort(messages, {}, &Message::stamp);
}

}  // namespace

RunRecord read_run_record(const std::filesystem::path& log_mcap) {
  RunRecord record;
  io::LogHandlers handlers;
  handlers.on<UwbPoseEstimate>([&](Time log_time, const UwbPoseEstimate& pose) {
    if (!append(record.T_map_body_by_ranges, pose.stamp, to_pose3(pose.T_map_body))) return;
    record.T_map_body_by_ranges_received.push_back(log_time);
  });
  handlers.on<PoseEstimate>([&](Time log_time, const PoseEstimate& pose) {
    if (!append(record.T_map_body, pose.stamp, to_pose3(pose.T_map_body))) return;
    record.T_map_body_received.push_back(log_time);
    record.covariances.push_back(pose.covariance);
  });
  handlers.on<SiteRegistration>(
      [&](Time, const SiteRegistration& registration) { record.registrations.push_back(registration); });
  handlers.on<OdometryEstimate>([&](Time log_time, const OdometryEstimate& odometry) {
    if (!append(record.T_odom_body, odometry.stamp, odometry.T_odom_body)) return;
    record.T_odom_body_received.push_back(log_time);
  });
  handlers.on<GroundTruth>(
      [&](Time, const GroundTruth& truth) { append(record.T_world_body, truth.stamp, truth.T_world_body); });
  handlers.on<Imu>([&](Time, const Imu& imu) { record.gyro.push_back({imu.stamp, imu.angular_velocity_radps}); });
  handlers.on<TrackTicks>([&](Time, const TrackTicks& ticks) {
    record.tracks.push_back({ticks.stamp, static_cast<double>(ticks.left), static_cast<double>(ticks.right)});
  });
  handlers.on<AsBuiltTruth>([&](Time, const AsBuiltTruth& as_built) { record.as_built = as_built; });
  handlers.on<CalibrationEstimate>(
      [&](Time, const CalibrationEstimate& calibration) { record.calibration = calibration; });
  handlers.on<FallReport>([&](Time, const FallReport&) { record.has_fall_report = true; });
  handlers.on<Event>([&](Time, const Event& event) { record.events.push_back(event); });
  handlers.on<Path>([&](Time, const Path& path) {
    if (path.T_map_body.empty()) record.has_empty_path = true;
    else ++record.num_paths;
  });
  handlers.on<Collision>([&](Time, const Collision& collision) { record.collisions.push_back(collision); });
  handlers.on<LocalizationConfidence>(
      [&](Time, const LocalizationConfidence& confidence) { record.confidences.push_back(confidence); });
  handlers.on<TeleopCommand>([&](Time, const TeleopCommand& command) { record.teleop.push_back(command); });
  handlers.on<LiningResult>([&](Time, const LiningResult& result) { record.linings.push_back(result); });
  handlers.on<WaterResult>([&](Time, const WaterResult& result) { record.waters.push_back(result); });
  handlers.on<MapUpdate>([&](Time, const MapUpdate& update) {
    record.map = update.map;
    record.has_empty_map = !record.has_map();
  });
  record.is_complete = io::read_run_log(log_mcap, handlers);
  sort_by_stamp(record.registrations);
  sort_by_stamp(record.confidences);
  if (record.T_world_body.empty()) throw InputError(fmt::format("{}: contains no ground truth", log_mcap.string()));
  return record;
}

Pose2 pose_of_map(const RunRecord& record, const std::optional<Pose2>& T_world_given_map) {
  if (T_world_given_map) return *T_world_given_map;
  if (!record.registrations.empty()) return record.registrations.back().T_site_map;
  if (!record.has_estimate()) return to_pose2(record.T_world_body.front().pose);
  return score::align_at_start(record.T_map_body, record.T_world_body);
}

}  // namespace patrol::app
