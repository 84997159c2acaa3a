#include "app/scoring/score_run.h"

#include "app/run/run_loop.h"
#include "app/run/run_record.h"
#include "app/scoring/localizability_track.h"
#include "app/scoring/run_scans.h"
#include "app/scoring/score_json.h"
#include "app/scoring/tour_metrics.h"
#include "app/scoring/tunnel_metrics.h"
#include "app/scoring/true_map.h"
#include "inspect/route_frame.h"
#include "io/map_server.h"
#include "io/nav_json.h"
#include "io/remote_csv.h"
#include "io/tum.h"
#include "score/driven_clearance.h"

namespace patrol::app {
namespace {

/// In world; the report draws by it.
io::Metrics pose_json(const Pose2& T_world_map) {
  return {{"x_m", T_world_map.x}, {"y_m", T_world_map.y}, {"yaw_rad", T_world_map.yaw}};
}

io::Metrics mission_metrics(const RunRecord& record) {
  io::Metrics metrics;
  metrics["completed"] = record.has_event(EventKind::kMissionCompleted);
  metrics["fell"] = record.has_event(EventKind::kFall);
  metrics["collisions"] = record.collisions.size();
  metrics["sensor_faults_noticed"] = record.num_events(EventKind::kSensorFault);
  metrics["duration_s"] = to_seconds(record.T_world_body.back().stamp);
  metrics["distance_m"] = planar_length_m(record.T_world_body);
  return metrics;
}

io::Metrics navigation_metrics(const RunRecord& record, const ScenarioFiles& files, const TrueMap& truth) {
  io::Metrics metrics;
  metrics["paths"] = record.num_paths;
  metrics["detours"] = record.num_events(EventKind::kReplan);
  metrics["recoveries"] = record.num_events(EventKind::kRecovery);
  metrics["clearance"] = to_json(score::driven_clearance(record.T_world_body, files.robot.footprint_m, truth.reference.cells));
  return metrics;
}

std::vector<score::TrueLeak> true_leaks(const Scenario& scenario, const mjModel& world) {
  std::vector<score::TrueLeak> leaks;
  for (const sim::LeakSettings& leak : scenario.leaks) {
    leaks.push_back({.name = leak.at, .p_world_m = sim::leak_source(world, leak).head<2>()});
  }
  return leaks;
}

void save_trajectories(const RunDirectory& directory, const RunRecord& record) {
  io::save_tum(directory.estimate(), record.T_map_body, "base_link in map, as the stack believed");
  io::save_tum(directory.truth(), record.T_world_body, "base_link in world, as it was");
  io::save_tum(directory.odometry(), record.T_odom_body, "base_link in odom, by legs or tracks and IMU alone");
}

/// What a drive by remote control leaves: its commands, to be driven again, and the goals that were marked.
void save_drive(const RunDirectory& directory, const Scenario& scenario, const RunRecord& record) {
  if (record.remote.empty()) return;
  io::save_remote(directory.remote(), record.remote);
  std::vector<MarkedGoal> goals;
  for (const Event& event : record.events) {
    if (event.kind != EventKind::kGoalMarked) continue;
    goals.push_back({.number = static_cast<int>(goals.size()) + 1, .T_map_body = event.T_map_body, .type = scenario.stack.tour.type_of_mark(goals.size())});
  }
  if (!goals.empty()) io::save_nav(directory.nav(), goals);
}

}  // namespace

io::Metrics score_run(const RunDirectory& directory, const Scenario& scenario, const ScenarioFiles& files) {
  const RunRecord record = read_run_record(directory.log());
  io::Metrics metrics;
  metrics["mission"] = mission_metrics(record);
  if (!record.has_estimate()) return metrics;
  save_trajectories(directory, record);
  save_drive(directory, scenario, record);
  if (const auto scans = station_scans(directory, record, scenario, files); !scans.empty()) io::save_station_scans(directory.scans(), scans);
  const TrueMap truth = true_map(record, scenario, files);
  io::save_map(directory.map(), record.map);
  io::save_map(directory.truth_map(), score::seeable_part(truth.reference));

  // A map that was there before has its origin where the survey says; one that the robot makes, where the robot truly started.
  const Pose2 T_world_map =
      files.map ? files.T_site_start : score::join_at_start(record.T_map_body, record.T_world_body);
  const Pose2 T_world_odom = score::join_at_start(record.T_odom_body, record.T_world_body);
  metrics["pose"] = to_json(score::trajectory_error(record.T_map_body, T_world_map, record.T_world_body));
  metrics["pose"]["aligned"] = to_json(score::aligned_error(record.T_map_body, record.T_world_body));
  metrics["odometry"] = to_json(score::trajectory_error(record.T_odom_body, T_world_odom, record.T_world_body));
  const score::MapError map_error = score::map_error(record.map, T_world_map, truth.reference);
  io::save_map_errors(directory.map_errors(), map_error.cells_m);
  metrics["map"] = to_json(map_error);
  metrics["map"]["origin_in_world"] = pose_json(T_world_map);
  metrics["map"]["reference_agreement"] = truth.reference_agreement;  // of its render with rays
  const std::vector<TrackedLocalizability> localizability =
      track_localizability(record, T_world_map, LocalizabilityOracle(*truth.world, scenario.sensors.lidar, truth.lidar_height_m));
  save_localizability(directory.localizability(), localizability);
  metrics["localizability"] = to_json(score_of(localizability));
  metrics["navigation"] = navigation_metrics(record, files, truth);
  metrics["stations"] = to_json(score::station_errors(files.route, record.events, T_world_map, record.T_world_body, record.map,
                                                      truth.reference));
  metrics.update(tour_metrics(record, scenario, files, T_world_map));
  metrics["inspection"] = to_json(score::inspection_score(record.events, T_world_map, true_leaks(scenario, *truth.world)));
  metrics["inspection"].update(tunnel_metrics(record, scenario, files, T_world_map));
  return metrics;
}

io::Metrics score_trajectories(const Trajectory& estimate, const Trajectory& reference) {
  const Pose2 T_reference_estimate = score::join_at_start(estimate, reference);
  io::Metrics metrics;
  metrics["pose"] = to_json(score::trajectory_error(estimate, T_reference_estimate, reference));
  metrics["pose"]["aligned"] = to_json(score::aligned_error(estimate, reference));
  return metrics;
}

io::Metrics score_maps(const OccupancyGrid& built, const OccupancyGrid& reference) {
  const score::ReferenceMap all_seeable{reference, Grid<std::uint8_t>(reference.geometry(), 1)};
  io::Metrics metrics;
  metrics["map"] = to_json(score::map_error(built, {}, all_seeable));
  return metrics;
}

}  // namespace patrol::app
