#include "app/score_run.h"

#include <cmath>

#include "app/run_loop.h"
#include "app/run_record.h"
#include "inspect/route_frame.h"
#include "io/map_server.h"
#include "io/nav_json.h"
#include "io/remote_csv.h"
#include "io/tum.h"
#include "render/reference_map.h"
#include "score/goal_error.h"
#include "score/inspection_score.h"
#include "score/localization_score.h"
#include "score/map_error.h"
#include "score/station_error.h"
#include "score/statistics.h"
#include "score/trajectory_error.h"

namespace patrol::app {
namespace {

constexpr double kReferenceResolution_m = 0.025;

io::Metrics to_json(const score::TrajectoryError& error) {
  io::Metrics metrics;
  metrics["ate_rmse_m"] = error.ate_rmse_m;
  metrics["ate_mean_m"] = error.ate_mean_m;
  metrics["ate_max_m"] = error.ate_max_m;
  metrics["heading_rmse_deg"] = error.heading_rmse_deg;
  metrics["rpe_trans_1m_m"] = error.rpe_trans_1m_m;
  metrics["rpe_rot_1m_deg"] = error.rpe_rot_1m_deg;
  metrics["poses"] = error.num_poses;
  return metrics;
}

io::Metrics to_json(const score::AlignedError& error) {
  io::Metrics metrics;
  metrics["rmse_m"] = error.rmse_m;
  metrics["mean_m"] = error.mean_m;
  metrics["max_m"] = error.max_m;
  metrics["pairs"] = error.num_pairs;
  return metrics;
}

io::Metrics to_json(const score::MapError& error) {
  io::Metrics metrics;
  metrics["nearest_mean_m"] = error.nearest_mean_m;
  metrics["nearest_var_m2"] = error.nearest_var_m2;
  metrics["nearest_p95_m"] = error.nearest_p95_m;
  metrics["coverage"] = error.coverage;
  metrics["iou"] = error.iou;
  metrics["occupied_cells"] = error.num_occupied;
  return metrics;
}

io::Metrics to_json(const std::vector<score::StationError>& errors) {
  io::Metrics list = io::Metrics::array();
  for (const score::StationError& error : errors) {
    io::Metrics station;
    station["name"] = error.name;
    station["reached"] = error.is_reached;
    const auto if_reached = [&](double value) { return error.is_reached ? io::Metrics(value) : io::Metrics(); };
    station["position_error_m"] = if_reached(error.position_error_m);
    station["heading_error_deg"] = if_reached(error.heading_error_deg);
    station["stand_error_m"] = if_reached(error.stand_error_m);
    station["map_error_m"] = error.map_error_m ? io::Metrics(*error.map_error_m) : io::Metrics();
    list.push_back(station);
  }
  return list;
}

io::Metrics to_json(const score::InspectionScore& score) {
  io::Metrics metrics;
  metrics["leaks"] = score.leaks;
  metrics["leaks_found"] = score.leaks_found;
  metrics["false_alarms"] = score.false_alarms;
  metrics["findings"] = io::Metrics::array();
  for (const score::Finding& finding : score.findings) {
    io::Metrics entry;
    entry["station"] = finding.station;
    entry["column_ppm_m"] = finding.column_ppm_m;
    entry["x_m"] = finding.p_world_m.x();
    entry["y_m"] = finding.p_world_m.y();
    entry["leak"] = finding.leak.empty() ? io::Metrics() : io::Metrics(finding.leak);
    entry["position_error_m"] = finding.leak.empty() ? io::Metrics() : io::Metrics(finding.error_m);
    metrics["findings"].push_back(entry);
  }
  return metrics;
}

io::Metrics spread_of(const std::vector<double>& values) {
  io::Metrics metrics;
  metrics["mean"] = values.empty() ? io::Metrics() : io::Metrics(score::mean(values));
  metrics["std"] = values.empty() ? io::Metrics() : io::Metrics(std::sqrt(score::variance(values)));
  metrics["max"] = values.empty() ? io::Metrics() : io::Metrics(score::maximum(values));
  return metrics;
}

io::Metrics to_json(const score::GoalError& error) {
  io::Metrics metrics;
  metrics["name"] = error.name;
  metrics["arrivals"] = error.arrivals.size();
  metrics["failed"] = error.num_failed;
  metrics["position_error_m"] = spread_of(error.position_errors_m());
  metrics["heading_error_deg"] = spread_of(error.heading_errors_deg());
  return metrics;
}

io::Metrics optional_json(const std::optional<double>& value) { return value ? io::Metrics(*value) : io::Metrics(); }

io::Metrics to_json(const score::LocalizationScore& score) {
  io::Metrics metrics;
  metrics["max_error_m"] = score.max_error_m;
  metrics["min_trust"] = score.min_trust;
  metrics["doubted_s"] = optional_json(score.doubted_s);
  metrics["strayed_s"] = optional_json(score.strayed_s);
  metrics["doubted_before_straying"] = score.strayed_s ? io::Metrics(score.doubted_s && *score.doubted_s < *score.strayed_s) : io::Metrics();
  metrics["lost_s"] = score.lost_s;
  return metrics;
}

io::Metrics to_json(const score::RelocalizationScore& score) {
  io::Metrics metrics;
  metrics["at_s"] = score.at_s;
  metrics["moved_m"] = score.moved_m;
  metrics["said_lost_s"] = optional_json(score.said_lost_s);
  metrics["relocalized_s"] = optional_json(score.relocalized_s);
  return metrics;
}

/// Of a robot that drives a tour: nothing in the log, nothing here.
void add_tour_metrics(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files, const Pose2& T_world_map,
                      io::Metrics& metrics) {
  const std::vector<score::GoalError> goals = score::goal_errors(record.events, files.goals, T_world_map, record.T_world_body);
  if (!goals.empty()) metrics["goals"] = io::Metrics::array();
  for (const score::GoalError& goal : goals) metrics["goals"].push_back(to_json(goal));
  if (files.route.dock) {
    metrics["docking"] = to_json(score::docking_error(record.events, files.route.dock->T_route_docked, record.T_world_body));
    metrics["docking"].erase("name");
  }
  if (record.trusts.empty()) return;
  std::vector<score::MatchedPose> matched = score::match_poses(record.T_map_body, T_world_map, record.T_world_body);
  std::erase_if(matched, [&](const score::MatchedPose& pose) { return pose.stamp < record.trusts.front().stamp; });
  metrics["localization"] = to_json(score::localization_score(matched, record.trusts));
  for (const KidnapSettings& kidnap : scenario.kidnaps) {
    metrics["localization"]["kidnaps"].push_back(
        to_json(score::relocalization_score(from_seconds(kidnap.at_s), matched, record.trusts)));
  }
}

io::Metrics mission_metrics(const RunRecord& record) {
  io::Metrics metrics;
  metrics["completed"] = record.has_event("mission_completed");
  metrics["fell"] = record.has_event("fall");
  metrics["collisions"] = record.collisions.size();
  metrics["duration_s"] = to_seconds(record.T_world_body.back().stamp);
  metrics["distance_m"] = planar_length_m(record.T_world_body);
  return metrics;
}

/// The world at the lidar's mean height on this run.
render::ReferenceMap world_map(const RunRecord& record, const ScenarioFiles& files, const mjModel& world) {
  double height_m = 0.0;
  for (const StampedPose& entry : record.T_world_body) height_m += entry.pose.position.z();
  height_m = height_m / static_cast<double>(record.T_world_body.size()) + files.robot.T_body("lidar").position.z();
  return render::reference_map(world, {.height_m = height_m, .resolution_m = kReferenceResolution_m});
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
  io::save_tum(directory.odometry(), record.T_odom_body, "base_link in odom, by legs and IMU alone");
}

/// What a drive by remote control leaves: its commands, to be driven again, and the goals that were marked.
void save_drive(const RunDirectory& directory, const RunRecord& record) {
  if (record.remote.empty()) return;
  io::save_remote(directory.remote(), record.remote);
  std::vector<MarkedGoal> goals;
  for (const Event& event : record.events) {
    if (event.kind != "goal_marked") continue;
    goals.push_back({.number = static_cast<int>(goals.size()) + 1, .T_map_body = event.T_map_body});
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
  save_drive(directory, record);
  const sim::SpecPtr spec = sim::load_spec(files.world_xml.string());
  const sim::ModelPtr world = sim::compile(*spec, files.world_xml.string());
  const render::ReferenceMap truth = world_map(record, files, *world);
  const score::ReferenceMap reference =
      score::mark_seeable(truth.map, record.T_world_body, scenario.sensors.lidar.range_max_m);
  io::save_map(directory.map(), record.map);
  io::save_map(directory.truth_map(), score::seeable_part(reference));

  // A map that was there before has its origin where the survey says; one that the robot makes, where the robot truly started.
  const Pose2 T_world_map =
      files.map ? files.T_site_start : score::join_at_start(record.T_map_body, record.T_world_body);
  const Pose2 T_world_odom = score::join_at_start(record.T_odom_body, record.T_world_body);
  metrics["pose"] = to_json(score::trajectory_error(record.T_map_body, T_world_map, record.T_world_body));
  metrics["pose"]["aligned"] = to_json(score::aligned_error(record.T_map_body, record.T_world_body));
  metrics["odometry"] = to_json(score::trajectory_error(record.T_odom_body, T_world_odom, record.T_world_body));
  metrics["map"] = to_json(score::map_error(record.map, T_world_map, reference));
  metrics["map"]["reference_agreement"] = truth.check.share_agreeing();  // of its render with rays
  metrics["stations"] = to_json(score::station_errors(files.route, record.events, T_world_map, record.T_world_body, record.map,
                                                      reference));
  add_tour_metrics(record, scenario, files, T_world_map, metrics);
  metrics["inspection"] = to_json(score::inspection_score(record.events, T_world_map, true_leaks(scenario, *world)));
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
