#include "score/run_score.h"

namespace patrol::score {
namespace {

NavigationScore navigation_score(const RunRecord& record, const RunReferences& references) {
  return {.num_paths = record.num_paths,
          .num_detours = record.num_events(EventKind::kReplan),
          .num_recoveries = record.num_events(EventKind::kRecovery),
          .clearance = driven_clearance(record.T_world_body, references.footprint_m, references.map.cells)};
}

std::optional<KnownMapScore> known_map_score(const RunRecord& record, const RunReferences& references,
                                             const Pose2& T_world_map) {
  if (record.confidences.empty()) return std::nullopt;
  std::vector<MatchedPose> matched = pair_poses(record.T_map_body, T_world_map, record.T_world_body);
  std::erase_if(matched, [&](const MatchedPose& pose) { return pose.stamp < record.confidences.front().stamp; });
  KnownMapScore score{.localization = localization_score(matched, record.confidences), .kidnaps = {}};
  for (const Time kidnapped : references.kidnaps)
    score.kidnaps.push_back(relocalization_score(kidnapped, matched, record.confidences));
  return score;
}

/// Adds the error of each station in the map as the robot places it in site.
void add_site_map_errors(const RunRecord& record, const RunReferences& references, EstimateScore& score) {
  for (std::size_t i = 0; i < score.stations.size(); ++i) {
    score.stations[i].site_map_error_m = map_displacement_m(record.map, score.site.T_site_map, references.map,
                                                            references.route.stations[i].p_route_target.head<2>());
  }
}

void add_inspection(const RunRecord& record, const RunReferences& references, EstimateScore& score) {
  score.inspection = inspection_score(record.events, score.T_world_map, references.leaks);
  if (!record.linings.empty() && references.lining) {
    score.lining = lining_score(record.linings, *references.lining, to_pose3(score.T_world_map));
  }
  if (!record.waters.empty() && references.p_body_antenna) {
    score.water = water_score(record.waters, references.waters, score.T_world_map, record.T_world_body,
                              *references.p_body_antenna);
  }
}

}  // namespace

MissionScore mission_score(const RunRecord& record) {
  return {.is_completed = record.has_event(EventKind::kMissionCompleted),
          .has_fallen = record.has_event(EventKind::kFall),
          .num_collisions = record.collisions.size(),
          .num_sensor_faults = record.num_events(EventKind::kSensorFault),
          .duration_s = to_seconds(record.T_world_body.back().stamp),
          .distance_m = planar_length_m(record.T_world_body)};
}

EstimateScore estimate_score(const RunRecord& record, const RunReferences& references) {
  const Trajectory& truth = record.T_world_body;
  // A given map has its origin where the survey says; a map of the run has it where the robot truly started.
  const Pose2 T_world_map = references.T_world_map ? *references.T_world_map : align_at_start(record.T_map_body, truth);
  EstimateScore score{
      .T_world_map = T_world_map,
      .pose = trajectory_error(record.T_map_body, T_world_map, truth),
      .site = site_score(record.T_map_body, record.registrations, references.T_site_start, truth),
      .aligned_pose = aligned_error(record.T_map_body, truth),
      .odometry = trajectory_error(record.T_odom_body, align_at_start(record.T_odom_body, truth), truth),
      .map = map_error(record.map, T_world_map, references.map),
      .map_agreement = references.map_agreement,
      .localizability = track_localizability(record, T_world_map, references.localizability),
      .navigation = navigation_score(record, references),
      .stations = station_errors(references.route, record.events, T_world_map, truth, record.map, references.map),
      .goals = goal_errors(record.events, references.goals, T_world_map, truth),
      .docking = {},
      .range_pose = {},
      .known_map = known_map_score(record, references, T_world_map),
      .inspection = {},
      .lining = {},
      .water = {}};
  add_site_map_errors(record, references, score);
  if (references.route.dock) score.docking = docking_error(record.events, references.route.dock->T_route_docked, truth);
  if (!record.T_map_body_by_ranges.empty())
    score.range_pose = trajectory_error(record.T_map_body_by_ranges, T_world_map, truth);
  add_inspection(record, references, score);
  return score;
}

}  // namespace patrol::score
