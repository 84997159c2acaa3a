#include "app/scoring/score_json.h"

#include <cmath>
#include <optional>

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
  return {{"mean_m", clearance.mean_m}, {"p05_m", clearance.p05_m}, {"min_m", clearance.min_m}};
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
  metrics["min_trust"] = score.min_trust;
  metrics["doubted_s"] = optional_json(score.doubted_s);
  metrics["strayed_s"] = optional_json(score.strayed_s);
  metrics["doubted_before_straying"] = score.strayed_s ? io::Metrics(score.doubted_s && *score.doubted_s < *score.strayed_s) : io::Metrics();
  metrics["lost_s"] = score.lost_s;
  return metrics;
}

io::Metrics to_json(const score::LocalizabilityScore& score) {
  io::Metrics metrics;
  metrics["poses"] = score.num_poses;
  metrics["weak_std_median_m"] = score.weak_std_median_m;
  metrics["weak_std_max_m"] = score.weak_std_max_m;
  metrics["degenerate_share"] = score.degenerate_share;
  metrics["covariance_rank_correlation"] = optional_json(score.covariance_rank_correlation);
  metrics["covariance_detection"] = optional_json(score.covariance_detection);
  metrics["trust_rank_correlation"] = optional_json(score.trust_rank_correlation);
  metrics["trust_detection"] = optional_json(score.trust_detection);
  metrics["weak_direction_error_deg"] = optional_json(score.weak_direction_error_deg);
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

}  // namespace patrol::app
