#include "app/run/run_record.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/run_log.h"

namespace patrol::app {
namespace {

/// Stamps must grow: a message that came twice, or late, is left out.
void append(Trajectory& trajectory, Time stamp, const Pose3& pose) {
  if (trajectory.empty() || stamp > trajectory.back().stamp) trajectory.push_back({stamp, pose});
}

}  // namespace

RunRecord read_run_record(const std::filesystem::path& log_mcap) {
  RunRecord record;
  io::LogHandlers handlers;
  handlers.range_pose = [&](Time, const RangePoseEstimate& pose) {
    append(record.T_map_body_by_ranges, pose.stamp, to_spatial(pose.T_map_body));
  };
  handlers.pose = [&](Time, const PoseEstimate& pose) {
    append(record.T_map_body, pose.stamp, to_spatial(pose.T_map_body));
    if (record.covariances.size() < record.T_map_body.size()) record.covariances.push_back(pose.covariance);
  };
  handlers.odometry = [&](Time, const OdometryEstimate& odometry) {
    append(record.T_odom_body, odometry.stamp, odometry.T_odom_body);
  };
  handlers.truth = [&](Time, const GroundTruth& truth) { append(record.T_world_body, truth.stamp, truth.T_world_body); };
  handlers.event = [&](Time, const Event& event) { record.events.push_back(event); };
  handlers.path = [&](Time, const Path&) { ++record.num_paths; };
  handlers.collision = [&](Time, const Collision& collision) { record.collisions.push_back(collision); };
  handlers.trust = [&](Time, const LocalizationTrust& trust) { record.trusts.push_back(trust); };
  handlers.remote = [&](Time, const RemoteCommand& command) { record.remote.push_back(command); };
  handlers.lining = [&](Time, const LiningResult& result) { record.linings.push_back(result); };
  handlers.water = [&](Time, const WaterResult& result) { record.waters.push_back(result); };
  handlers.map = [&](Time, const MapUpdate& update) { record.map = update.map; };
  record.is_complete = io::read_run_log(log_mcap, handlers);
  if (record.T_world_body.empty()) throw InputError(fmt::format("{}: holds no ground truth", log_mcap.string()));
  return record;
}

}  // namespace patrol::app
