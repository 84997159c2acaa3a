#include "app/scoring/tunnel_metrics.h"

#include <algorithm>
#include <string>
#include <vector>

#include "score/lining_score.h"
#include "score/water_score.h"
#include "sim/lining_moves.h"

namespace patrol::app {
namespace {

io::Metrics if_found(bool is_found, double value) { return is_found ? io::Metrics(value) : io::Metrics(); }

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
  metrics["max_place_error_m"] = if_found(score.found > 0, score.max_place_error_m);
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
                                {"place_error_m", if_found(ring.is_found, ring.place_error_m)}});
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
    metrics["findings"].push_back({{"name", finding.station},
                                   {"is_true", is_true},
                                   {"position_error_m", if_found(is_true, finding.position_error_m)},
                                   {"ahead_error_m", if_found(is_true, finding.ahead_error_m)},
                                   {"radius_error_m", if_found(is_true, finding.radius_error_m)},
                                   {"distance_holds", is_true ? io::Metrics(finding.distance_holds) : io::Metrics()},
                                   {"position_holds", is_true ? io::Metrics(finding.position_holds) : io::Metrics()},
                                   {"radius_holds", is_true ? io::Metrics(finding.radius_holds) : io::Metrics()}});
  }
  metrics["position_error_m"] = if_found(score.found > 0, worst_m);
  return metrics;
}

std::vector<score::TrueWater> true_waters(const Scenario& scenario) {
  std::vector<score::TrueWater> bodies;
  for (const sim::WaterBodySettings& body : scenario.water) bodies.push_back({.p_world_m = {body.x_m, body.y_m, body.z_m}, .radius_m = body.radius_m});
  return bodies;
}

}  // namespace

io::Metrics tunnel_metrics(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files, const Pose2& T_world_map) {
  io::Metrics metrics = io::Metrics::object();
  if (!record.linings.empty() && files.route.lining) {
    const score::TrueLining truth{.design = *files.route.lining, .invert_m = 0.0,
                                  .inward_m = [&](int ring, double clock_deg) { return sim::inward_m(scenario.lining, ring, clock_deg); }};
    metrics["lining"] = to_json(score::lining_score(record.linings, truth, to_spatial(T_world_map)));
  }
  if (!record.waters.empty() && files.robot.antenna) {
    metrics["water"] = to_json(score::water_score(record.waters, true_waters(scenario), T_world_map, record.T_world_body,
                                                  files.robot.antenna->T_body_mount.position));
  }
  return metrics;
}

}  // namespace patrol::app
