#include "app/scoring/run_references.h"

#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/scoring/localizability_oracle.h"
#include "app/scoring/mapping_lidar.h"
#include "sim/lining_deformation.h"

namespace patrol::app {
namespace {

std::vector<score::LeakGroundTruth> true_leaks(const Scenario& scenario, const mjModel& world) {
  std::vector<score::LeakGroundTruth> leaks;
  for (const sim::LeakSettings& leak : scenario.leaks) {
    leaks.push_back({.name = leak.at, .p_world_m = sim::leak_source(world, leak).head<2>()});
  }
  return leaks;
}

std::vector<score::WaterGroundTruth> true_waters(const Scenario& scenario) {
  std::vector<score::WaterGroundTruth> bodies;
  for (const sim::WaterBodySettings& body : scenario.water_bodies) {
    bodies.push_back({.p_world_m = {body.x_m, body.y_m, body.z_m}, .radius_m = body.radius_m});
  }
  return bodies;
}

/// Rotation of the lidar in body; identity for a robot without a lidar.
Eigen::Quaterniond lidar_rotation(const RobotDescription& robot) {
  const auto lidar = robot.T_body_sensor.find("lidar");
  return lidar == robot.T_body_sensor.end() ? Eigen::Quaterniond::Identity() : lidar->second.rotation;
}

/// Sum of the clock offsets by faults of the lidar.
double lidar_clock_fault_s(const std::vector<sim::FaultSettings>& faults, Time now) {
  double offset_s = 0.0;
  for (const sim::FaultSettings& fault : faults)
    if (fault.sensor == "lidar" && fault.kind == "clock_offset" && fault.is_active(now)) offset_s += fault.magnitude;
  return offset_s;
}

}  // namespace

score::RunReferences run_references(const Scenario& scenario, const ScenarioFiles& files, const TrueMap& truth) {
  score::LocalizabilityOracle localizability;
  if (const auto lidar = mapping_lidar(files.robot)) {
    const auto oracle =
        std::make_shared<LocalizabilityOracle>(*truth.world, scenario.sensors.*lidar->settings, truth.lidar_height_m);
    localizability = [oracle](const Eigen::Vector2d& p_world_m) { return oracle->at(p_world_m); };
  }
  score::RunReferences references{
      .map = truth.reference,
      .map_agreement = truth.reference_agreement,
      .T_site_start = files.T_site_start,
      .T_world_map = {},
      .route = files.route,
      .goals = files.goals,
      .footprint_m = files.robot.footprint_m,
      .leaks = true_leaks(scenario, *truth.world),
      .lining = {},
      .waters = true_waters(scenario),
      .p_body_antenna = {},
      .kidnaps = {},
      .calibration = {.R_body_imu = files.robot.T_body("imu").rotation,
                      .R_body_lidar = lidar_rotation(files.robot),
                      .lidar_clock_fault_s =
                          [faults = scenario.faults](Time now) { return lidar_clock_fault_s(faults, now); }},
      .localizability = std::move(localizability)};
  if (files.map) references.T_world_map = files.T_site_map();
  if (files.route.lining) {
    references.lining =
        score::LiningGroundTruth{.design = *files.route.lining,
                                 .invert_m = 0.0,
                                 .inward_m = [moves = scenario.lining_deformation](int ring, double clock_deg) {
                                   return sim::inward_m(moves, ring, clock_deg);
                                 }};
  }
  if (files.robot.antenna) references.p_body_antenna = files.robot.antenna->T_body_mount.position;
  for (const KidnapSettings& kidnap : scenario.kidnaps) references.kidnaps.push_back(from_seconds(kidnap.at_s));
  return references;
}

std::vector<score::MissionGoal> mission_goals(const Scenario& scenario, const ScenarioFiles& files) {
  const bool visits_stations = scenario.stack.mission_type == "gas";
  const bool visits_goals = !visits_stations && scenario.stack.tunnel_mission.num_runs > 0;
  std::vector<score::MissionGoal> goals;
  for (const Station& station : files.route.stations) {
    goals.push_back({.name = station.name,
                     .arrival = EventKind::kStationReached,
                     .p_world_m = station.T_route_body.position(),  // site is world
                     .accuracy_m = station.accuracy_m,
                     .is_required = visits_stations});
  }
  for (const SavedGoal& goal : files.goals) {
    if (!files.map) break;  // the pose of a map that the run makes is not given
    goals.push_back({.name = goal.name(),
                     .arrival = EventKind::kGoalReached,
                     .p_world_m = (files.T_site_map() * goal.T_map_body).position(),
                     .accuracy_m = goal.accuracy_m,
                     .is_required = visits_goals && goal.type != GoalType::kVia});
  }
  if (files.route.dock) {
    goals.push_back(
        {.name = "", .arrival = EventKind::kDocked, .p_world_m = files.route.dock->T_route_docked.position()});
  }
  return goals;
}

}  // namespace patrol::app
