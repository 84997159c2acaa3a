#include "app/scoring/run_scans.h"

#include <algorithm>
#include <optional>
#include <string>

#include "inspect/lining/reference.h"
#include "io/logs/run_log.h"
#include "stack/instruments/station_pose.h"

namespace patrol::app {
namespace {

/// Station of a panoramic scan: subject of the first scan-taken event from its stamp on; none without such an event.
std::optional<std::string> find_station(const PanoramicScan& scan, const RunRecord& record) {
  const auto taken = std::find_if(record.events.begin(), record.events.end(), [&](const Event& event) {
    return event.kind == EventKind::kScanTaken && event.stamp >= scan.stamp;
  });
  return taken == record.events.end() ? std::nullopt : std::optional(taken->subject);
}

std::optional<stack::StationPose> to_tunnel_coordinates(const PanoramicScan& scan, const std::string& station,
                                                        const RunRecord& record, double height_m) {
  const std::optional<Pose3> T_map_body = pose_at(record.T_map_body, scan.stamp),
                             T_odom_body = pose_at(record.T_odom_body, scan.stamp);
  if (!T_map_body || !T_odom_body) return std::nullopt;
  const Eigen::Quaterniond tilt = quaternion_from_yaw(-to_yaw(T_odom_body->rotation)) * T_odom_body->rotation;
  stack::StationPose station_pose{.T_level_body = {{0.0, 0.0, height_m}, tilt}, .T_map_body = to_pose2(*T_map_body)};
  const auto result = std::find_if(record.linings.begin(), record.linings.end(), [&](const LiningResult& lining) {
    return lining.station == station && lining.stamp >= scan.stamp && lining.is_registered;
  });
  if (result != record.linings.end()) station_pose.T_map_body = result->T_map_body;
  return station_pose;
}

}  // namespace

std::vector<io::StationScan> station_scans(const std::filesystem::path& log_mcap, const RunRecord& record,
                                           const Scenario& scenario, const ScenarioFiles& files) {
  std::vector<io::StationScan> scans;
  if (!scenario.sensors.scanner.enabled) return scans;
  io::LogHandlers handlers;
  handlers.on<PanoramicScan>([&](Time, const PanoramicScan& scan) {
    const std::optional<std::string> station = find_station(scan, record);
    if (!station || std::any_of(scans.begin(), scans.end(),
                                [&](const io::StationScan& known) { return known.station == *station; }))
      return;
    const auto station_pose = to_tunnel_coordinates(scan, *station, record, files.robot.body_height_m());
    if (!station_pose) return;
    const Pose3 T_map_scanner = station_pose->T_map_scanner(files.robot.T_body("scanner"));
    scans.push_back({.station = *station,
                     .T_map_scanner = T_map_scanner,
                     .points = inspect::make_reference(scan, T_map_scanner).points});
  });
  io::read_run_log(log_mcap, handlers);
  return scans;
}

}  // namespace patrol::app
