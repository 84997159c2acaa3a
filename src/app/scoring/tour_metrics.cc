#include "app/scoring/tour_metrics.h"

#include <vector>

#include "app/scoring/score_json.h"

namespace patrol::app {
io::Metrics tour_metrics(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files, const Pose2& T_world_map) {
  io::Metrics metrics = io::Metrics::object();
  const std::vector<score::GoalError> goals = score::goal_errors(record.events, files.goals, T_world_map, record.T_world_body);
  if (!goals.empty()) metrics["goals"] = io::Metrics::array();
  for (const score::GoalError& goal : goals) metrics["goals"].push_back(to_json(goal));
  if (files.route.dock) {
    metrics["docking"] = to_json(score::docking_error(record.events, files.route.dock->T_route_docked, record.T_world_body));
    metrics["docking"].erase("name");
  }
  if (!record.T_map_body_by_ranges.empty()) {
    metrics["range_pose"] = to_json(score::trajectory_error(record.T_map_body_by_ranges, T_world_map, record.T_world_body));
  }
  if (record.trusts.empty()) return metrics;
  std::vector<score::MatchedPose> matched = score::match_poses(record.T_map_body, T_world_map, record.T_world_body);
  std::erase_if(matched, [&](const score::MatchedPose& pose) { return pose.stamp < record.trusts.front().stamp; });
  metrics["localization"] = to_json(score::localization_score(matched, record.trusts));
  for (const KidnapSettings& kidnap : scenario.kidnaps) {
    metrics["localization"]["kidnaps"].push_back(
        to_json(score::relocalization_score(from_seconds(kidnap.at_s), matched, record.trusts)));
  }
  return metrics;
}

}  // namespace patrol::app
