#include "score/run/run_score.h"

#include <algorithm>
#include <array>
#include <limits>
#include <ranges>

#include "core/error.h"
#include "score/pose/live_trajectory.h"

namespace patrol::score {
namespace {

NavigationScore navigation_score(const RunRecord& record, const RunReferences& references) {
  return {.num_paths = record.num_paths,
          .num_detours = record.num_events(EventKind::kReplan),
          .num_recoveries = record.num_events(EventKind::kRecovery),
          .clearance = driven_clearance(record.T_world_body, references.footprint_m, references.map.cells,
                                        references.route.keep_out_lines)};
}

/// Estimates of a run on the common clock.
struct LiveEstimates {
  Trajectory T_map_body, T_map_body_by_ranges, T_odom_body;
};

LiveEstimates live_estimates(const RunRecord& record) {
  const Time end = record.T_world_body.back().stamp;
  const ReceivedPoses odometry{record.T_odom_body, record.T_odom_body_received};
  return {.T_map_body = live_trajectory({record.T_map_body, record.T_map_body_received}, odometry, end),
          .T_map_body_by_ranges =
              live_trajectory({record.T_map_body_by_ranges, record.T_map_body_by_ranges_received}, odometry, end),
          .T_odom_body = live_odometry(odometry, end)};
}

/// None when the estimate allows no fit.
std::optional<AlignedError> aligned_if_possible(const Trajectory& estimate, const Trajectory& reference) {
  try {
    return aligned_error(estimate, reference);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Error of the run's map; none if the robot passed no surface. A map without occupied cells covers nothing and has no
/// distances.
std::optional<MapError> run_map_error(const OccupancyGrid& built, const Pose2& T_world_map,
                                      const ReferenceMap& reference, const DistanceField& reference_field) {
  const auto is_seen = [&reference](std::size_t i) {
    return reference.is_observable.values()[i] != 0 && reference.cells.values()[i] == kOccupied;
  };
  const auto cells = std::views::iota(std::size_t{0}, reference.cells.values().size());
  if (std::ranges::none_of(cells, is_seen)) return std::nullopt;
  if (!occupied_points(built).empty()) return map_error(built, T_world_map, reference, reference_field);
  MapError error;
  error.cells_m = Grid<float>(built.geometry(), std::numeric_limits<float>::quiet_NaN());
  return error;
}

std::optional<KnownMapScore> known_map_score(const RunRecord& record, const Trajectory& live_T_site_body,
                                             const RunReferences& references) {
  if (record.confidences.empty()) return std::nullopt;
  std::vector<MatchedPose> matched = pair_poses(live_T_site_body, {}, record.T_world_body);
  std::erase_if(matched, [&](const MatchedPose& pose) { return pose.stamp < record.confidences.front().stamp; });
  KnownMapScore score{.localization = localization_score(matched, record.confidences, record.T_world_body.back().stamp),
                      .kidnaps = {}};
  for (const Time kidnapped : references.kidnaps) {
    Time next = Time::max();
    for (const Time other : references.kidnaps) {
      if (other > kidnapped) next = std::min(next, other);
    }
    score.kidnaps.push_back(relocalization_score(kidnapped, next, matched, record.confidences));
  }
  return score;
}

/// Adds the error of each station in the map as the robot places it in site.
void add_site_map_errors(const RunRecord& record, const Route& route, const DistanceField& reference_field,
                         EstimateScore& score) {
  for (std::size_t i = 0; i < score.stations.size(); ++i) {
    score.stations[i].site_map_error_m = map_displacement_m(record.map, score.site.T_site_map, reference_field,
                                                            route.stations[i].p_route_target.head<2>());
  }
}

std::vector<ScoredParameter> run_calibration_score(const RunRecord& record, const RunReferences& references) {
  if (!record.calibration || record.as_built.values.empty()) return {};
  const auto truth = calibration_truth({.T_odom_body = record.T_odom_body,
                                        .T_world_body = record.T_world_body,
                                        .gyro = record.gyro,
                                        .as_built = record.as_built,
                                        .kidnaps = references.kidnaps,
                                        .tracks = record.tracks},
                                       references.calibration, record.calibration->stamp);
  return calibration_score(*record.calibration, truth);
}

void add_inspection(const RunRecord& record, const RunReferences& references, const MapInSite& map,
                    EstimateScore& score) {
  score.inspection = inspection_score(record.events, map, references.leaks);
  if (!record.linings.empty() && references.lining) {
    score.lining = lining_score(record.linings, *references.lining, map);
  }
  if (!record.waters.empty() && references.p_body_antenna) {
    score.water = water_score(record.waters, references.waters, map, record.T_world_body, *references.p_body_antenna);
  }
}

}  // namespace

MissionScore mission_score(const RunRecord& record, const std::vector<MissionGoal>& goals) {
  const bool is_reported_completed = record.has_event(EventKind::kMissionCompleted);
  const ArrivalScore arrivals = arrival_score(record.events, goals, record.T_world_body);
  return {.is_completed = is_reported_completed && !arrivals.is_contradicted,
          .is_reported_completed = is_reported_completed,
          .num_false_arrivals = arrivals.num_false,
          .has_fallen = record.has_fall_report || record.has_event(EventKind::kFall),
          .num_collisions = record.collisions.size(),
          .num_sensor_faults = record.num_events(EventKind::kSensorFault),
          .duration_s = to_seconds(record.T_world_body.back().stamp),
          .distance_m = planar_length_m(record.T_world_body)};
}

EstimateScore estimate_score(const RunRecord& record, const RunReferences& references) {
  const Trajectory& truth = record.T_world_body;
  const LiveEstimates live = live_estimates(record);
  const MapInSite map(references.T_site_start, record.registrations);
  // A given map has its origin where its registration says; a map of the run has it where its cells fit the surfaces.
  // The final optimization may have turned it against the poses estimated before.
  const DistanceField reference_field(occupied_cells(references.map.cells));
  const std::array starts{fit_map_frame(live.T_map_body, truth), map.last().T_site_map};
  const Pose2 T_world_map =
      references.T_world_map ? *references.T_world_map : fit_map_to_reference(record.map, starts, reference_field);
  const Pose2 T_world_start =
      references.T_world_map ? *references.T_world_map : align_at_start(record.T_map_body, truth);
  EstimateScore score{
      .T_world_map = T_world_map,
      .pose = trajectory_error(live.T_map_body, T_world_start, truth),
      .site = site_score(live.T_map_body, map, truth),
      .pose_coverage = time_coverage(timely_poses({record.T_map_body, record.T_map_body_received}), truth),
      .nees = pose_nees(record.T_map_body, record.covariances, map, truth),
      .aligned_pose = aligned_if_possible(record.T_map_body, truth),
      .odometry = {},
      .map = {},
      .map_agreement = references.map_agreement,
      .localizability = track_localizability(record, T_world_map, references.localizability),
      .navigation = navigation_score(record, references),
      .stations = station_errors(references.route, record.events, T_world_map, map, truth, record.map, reference_field),
      .calibration = run_calibration_score(record, references),
      .goals = goal_errors(record.events, references.goals, T_world_map, truth),
      .docking = {},
      .range_pose = {},
      .known_map = known_map_score(record, map.place(live.T_map_body), references),
      .inspection = {},
      .lining = {},
      .water = {}};
  if (!live.T_odom_body.empty())
    score.odometry = trajectory_error(live.T_odom_body, align_at_start(record.T_odom_body, truth), truth);
  if (record.has_map() || record.has_empty_map)
    score.map = run_map_error(record.map, T_world_map, references.map, reference_field);
  add_site_map_errors(record, references.route, reference_field, score);
  if (references.route.dock) score.docking = docking_error(record.events, references.route.dock->T_route_docked, truth);
  if (!record.T_map_body_by_ranges.empty())
    score.range_pose = trajectory_error(map.place(live.T_map_body_by_ranges), {}, truth);
  add_inspection(record, references, map, score);
  return score;
}

}  // namespace patrol::score
