#include "app/scoring/tunnel_metrics.h"

#include <vector>

#include "app/scoring/score_json.h"
#include "sim/lining_moves.h"

namespace patrol::app {
namespace {

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
