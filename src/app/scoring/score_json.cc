#include "app/scoring/score_json.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "score/statistics.h"

namespace patrol::app {
namespace {

io::Metrics spread_of(const std::vector<double>& values) {
  io::Metrics metrics;
  metrics["mean"] = values.empty() ? io::Metrics() : io::Metrics(score::mean(values));
  metrics["std"] = values.empty() ? io::Metrics() : io::Metrics(std::sqrt(score::variance(values)));
  metrics["max"] = values.empty() ? io::Metrics() : io::Metrics(score::maximum(values));
  metrics["each"] = values;
  return metrics;
}

io::Metrics optional_json(const std::optional<double>& value) { return value ? io::Metrics(*value) : io::Metrics(); }

io::Metrics if_found(bool is_found, double value) { return is_found ? io::Metrics(value) : io::Metrics(); }

}  // namespace

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

io::Metrics to_json(const score::DrivenClearance& clearance) {
  io::Metrics metrics = {{"mean_m", clearance.mean_m}, {"p05_m", clearance.p05_m}, {"min_m", clearance.min_m}};
  if (clearance.keep_out_min_m) metrics["keep_out_min_m"] = *clearance.keep_out_min_m;
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

io::Metrics to_json(const score::PoseNees& score) {
  io::Metrics metrics;
  metrics["mean"] = if_found(score.has_mean(), score.mean);
  metrics["per_dimension"] = if_found(score.has_mean(), score.per_dimension());
  metrics["within_95"] = if_found(score.num_instants > 0, score.within_95);
  metrics["instants"] = score.num_instants;
  metrics["singular"] = score.num_singular;
  return metrics;
}

io::Metrics to_json(const score::MapError& error) {
  io::Metrics metrics;
  const bool has_cells = error.num_occupied > 0;
  metrics["nearest_mean_m"] = if_found(has_cells, error.nearest_mean_m);
  metrics["nearest_var_m2"] = if_found(has_cells, error.nearest_var_m2);
  metrics["nearest_p95_m"] = if_found(has_cells, error.nearest_p95_m);
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
    station["position_error_m"] = if_found(error.is_reported, error.position_error_m);
    station["heading_error_deg"] = if_found(error.is_reported, error.heading_error_deg);
    station["stand_error_m"] = if_found(error.is_reported, error.goal_position_error_m);
    station["map_error_m"] = error.map_error_m ? io::Metrics(*error.map_error_m) : io::Metrics();
    station["site_map_error_m"] = optional_json(error.site_map_error_m);
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
  for (const score::ScoredAlarm& finding : score.findings) {
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

io::Metrics to_json(const score::GoalError& error) {
  io::Metrics metrics;
  metrics["name"] = error.name;
  metrics["arrivals"] = error.arrivals.size();
  metrics["failed"] = error.num_failed;
  metrics["position_error_m"] = spread_of(error.position_errors_m());
  metrics["heading_error_deg"] = spread_of(error.heading_errors_deg());
  return metrics;
}

io::Metrics to_json(const score::LocalizationScore& score) {
  io::Metrics metrics;
  metrics["max_error_m"] = score.max_error_m;
  metrics["max_error_with_lost_m"] = score.max_error_with_lost_m;
  metrics["min_trust"] = score.min_confidence;
  metrics["doubted_s"] = optional_json(score.low_confidence_at_s);
  metrics["strayed_s"] = optional_json(score.error_exceeded_at_s);
  metrics["doubted_before_straying"] =
      score.error_exceeded_at_s
          ? io::Metrics(score.low_confidence_at_s && *score.low_confidence_at_s < *score.error_exceeded_at_s)
          : io::Metrics();
  metrics["lost_s"] = score.lost_s;
  return metrics;
}

io::Metrics to_json(const score::LocalizabilityScore& score) {
  io::Metrics metrics;
  metrics["poses"] = score.num_poses;
  metrics["weak_std_median_m"] = score.max_std_median_m;
  metrics["weak_std_max_m"] = score.max_std_max_m;
  metrics["degenerate_share"] = score.degenerate_fraction;
  metrics["covariance_rank_correlation"] = optional_json(score.covariance_rank_correlation);
  metrics["covariance_detection"] = optional_json(score.covariance_detection);
  metrics["trust_rank_correlation"] = optional_json(score.confidence_rank_correlation);
  metrics["trust_detection"] = optional_json(score.confidence_detection);
  metrics["weak_direction_error_deg"] = optional_json(score.max_std_direction_error_deg);
  return metrics;
}

io::Metrics to_json(const score::RelocalizationScore& score) {
  io::Metrics metrics;
  metrics["at_s"] = score.at_s;
  metrics["moved_m"] = score.displacement_m;
  metrics["said_lost_s"] = optional_json(score.time_to_detect_s);
  metrics["relocalized_s"] = optional_json(score.relocalized_s);
  return metrics;
}

io::Metrics to_json(const std::vector<score::ScoredParameter>& calibration) {
  io::Metrics metrics;
  std::size_t num_held = 0;
  for (const score::ScoredParameter& parameter : calibration) {
    std::string pointer = "/" + parameter.name;
    std::ranges::replace(pointer, '.', '/');
    metrics[io::Metrics::json_pointer(pointer)] = {
        {"value", parameter.value}, {"std", parameter.std}, {"truth", parameter.truth}, {"holds", parameter.holds()}};
    if (parameter.drawn) metrics[io::Metrics::json_pointer(pointer)]["drawn"] = *parameter.drawn;
    if (parameter.holds()) ++num_held;
  }
  metrics["parameters"] = calibration.size();
  metrics["within_95"] = static_cast<double>(num_held) / static_cast<double>(calibration.size());
  return metrics;
}

io::Metrics to_json(const score::LiningScore& score) {
  io::Metrics metrics;
  metrics["stations"] = score.stations;
  metrics["registered"] = score.registered;
  metrics["moved_rings"] = score.moved_rings;
  metrics["found"] = score.found;
  metrics["missed"] = score.missed;
  metrics["false_findings"] = score.false_findings;
  metrics["max_error_mm"] = if_found(score.found > 0, 1e3 * score.max_error_m);
  metrics["max_peak_error_mm"] = if_found(score.found > 0, 1e3 * score.max_peak_error_m);
  metrics["max_place_error_m"] = if_found(score.found > 0, score.max_position_error_m);
  metrics["cells"] = score.cells;
  metrics["cell_rmse_mm"] = if_found(score.cells > 0, 1e3 * score.cell_rmse_m);
  metrics["cell_coverage_95"] = if_found(score.cells > 0, score.cell_coverage_95);
  metrics["rings"] = io::Metrics::array();
  for (const score::RingScore& ring : score.rings) {
    metrics["rings"].push_back({{"name", ring.station + "_ring_" + std::to_string(ring.ring)},
                                {"station", ring.station},
                                {"ring", ring.ring},
                                {"true_peak_mm", 1e3 * ring.true_peak_m},
                                {"is_found", ring.is_found},
                                {"reported_mm", if_found(ring.is_found, 1e3 * ring.reported_m)},
                                {"error_mm", if_found(ring.is_found, 1e3 * ring.error_m)},
                                {"place_error_m", if_found(ring.is_found, ring.position_error_m)}});
  }
  return metrics;
}

io::Metrics to_json(const score::WaterScore& score) {
  io::Metrics metrics;
  metrics["stations"] = score.stations;
  metrics["bodies"] = score.bodies;
  metrics["found"] = score.found;
  metrics["missed"] = score.missed;
  metrics["false_alarms"] = score.false_alarms;
  metrics["findings"] = io::Metrics::array();
  double worst_m = 0.0;
  for (const score::WaterFinding& finding : score.findings) {
    const bool is_true = finding.body.has_value();
    if (is_true) worst_m = std::max(worst_m, finding.position_error_m);
    metrics["findings"].push_back(
        {{"name", finding.station},
         {"is_true", is_true},
         {"position_error_m", if_found(is_true, finding.position_error_m)},
         {"ahead_error_m", if_found(is_true, finding.ahead_error_m)},
         {"radius_error_m", if_found(is_true, finding.radius_error_m)},
         {"distance_holds", is_true ? io::Metrics(finding.distance_in_interval) : io::Metrics()},
         {"position_holds", is_true ? io::Metrics(finding.position_in_ellipsoid) : io::Metrics()},
         {"radius_holds", is_true ? io::Metrics(finding.radius_in_interval) : io::Metrics()}});
  }
  metrics["position_error_m"] = if_found(score.found > 0, worst_m);
  return metrics;
}

namespace {

io::Metrics mission_json(const score::MissionScore& mission) {
  return {{"completed", mission.is_completed},
          {"reported_completed", mission.is_reported_completed},
          {"false_arrivals", mission.num_false_arrivals},
          {"fell", mission.has_fallen},
          {"collisions", mission.num_collisions},
          {"sensor_faults_noticed", mission.num_sensor_faults},
          {"duration_s", mission.duration_s},
          {"distance_m", mission.distance_m}};
}

io::Metrics course_json(const score::CourseScore& course) {
  return {{"successful", course.is_successful},
          {"collided", course.has_collided},
          {"duration_s", optional_json(course.duration_s)},
          {"score", course.score}};
}

io::Metrics navigation_json(const score::NavigationScore& navigation) {
  return {{"paths", navigation.num_paths},
          {"detours", navigation.num_detours},
          {"recoveries", navigation.num_recoveries},
          {"clearance", to_json(navigation.clearance)}};
}

/// Pose of map in world, which the report uses to draw.
io::Metrics pose_json(const Pose2& T_world_map) {
  return {{"x_m", T_world_map.x}, {"y_m", T_world_map.y}, {"yaw_rad", T_world_map.yaw}};
}

io::Metrics registration_json(const score::SiteScore& site) {
  return {{"position_error_m", site.position_error_m},
          {"yaw_error_deg", site.yaw_error_deg},
          {"nees", optional_json(site.nees)},
          {"updates", site.num_registrations},
          {"map_in_site", pose_json(site.T_site_map)}};
}

void add_goals(const score::EstimateScore& score, io::Metrics& metrics) {
  for (const score::GoalError& goal : score.goals) metrics["goals"].push_back(to_json(goal));
  if (score.docking) {
    metrics["docking"] = to_json(*score.docking);
    metrics["docking"].erase("name");
  }
}

void add_localization(const score::EstimateScore& score, io::Metrics& metrics) {
  if (score.range_pose) metrics["range_pose"] = to_json(*score.range_pose);
  if (!score.known_map) return;
  metrics["localization"] = to_json(score.known_map->localization);
  for (const score::RelocalizationScore& kidnap : score.known_map->kidnaps)
    metrics["localization"]["kidnaps"].push_back(to_json(kidnap));
}

}  // namespace

io::Metrics to_json(const score::RunScore& run) {
  io::Metrics metrics;
  metrics["mission"] = mission_json(run.mission);
  if (run.course) metrics["course"] = course_json(*run.course);
  if (!run.estimate) return metrics;
  const score::EstimateScore& score = *run.estimate;
  metrics["pose"] = to_json(score.pose);
  metrics["pose"]["coverage"] = score.pose_coverage;
  metrics["pose"]["site"] = to_json(score.site.pose);
  metrics["pose"]["aligned"] = score.aligned_pose ? to_json(*score.aligned_pose) : io::Metrics();
  metrics["pose"]["nees"] = to_json(score.nees);
  metrics["registration"] = registration_json(score.site);
  if (!score.calibration.empty()) metrics["calibration"] = to_json(score.calibration);
  if (score.odometry) metrics["odometry"] = to_json(*score.odometry);
  if (score.map) metrics["map"] = to_json(*score.map);
  metrics["map"]["origin_in_world"] = pose_json(score.T_world_map);
  if (score.map) metrics["map"]["reference_agreement"] = score.map_agreement;
  metrics["localizability"] = to_json(score_of(score.localizability));
  metrics["navigation"] = navigation_json(score.navigation);
  metrics["stations"] = to_json(score.stations);
  add_goals(score, metrics);
  add_localization(score, metrics);
  metrics["inspection"] = to_json(score.inspection);
  if (score.lining) metrics["inspection"]["lining"] = to_json(*score.lining);
  if (score.water) metrics["inspection"]["water"] = to_json(*score.water);
  return metrics;
}

}  // namespace patrol::app
