#include "stack/make_stack.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "stack/instruments/gas_instrument.h"
#include "stack/instruments/water_instrument.h"
#include "stack/mission/gas_mission.h"
#include "stack/mission/station_order.h"
#include "stack/mission/tunnel_mission.h"

namespace patrol::stack {
namespace {

bool is_tunnel(const StackSettings& settings) { return settings.mission_type == "tunnel"; }

std::unique_ptr<Mission> make_gas_mission(const StackSettings& settings, const RobotDescription& robot,
                                          Route route_in_map, std::uint64_t seed) {
  const auto& stations = route_in_map.stations;
  if (std::any_of(stations.begin(), stations.end(),
                  [](const Station& station) { return station.type == StationType::kInspect; }))
    robot.T_body("tdlas");
  std::string order_text;
  if (settings.gas_mission.station_order == "optimized" && !route_in_map.stations.empty()) {
    StationOrder order = order_stations(route_in_map, robot, settings.navigation, settings.gas_mission, seed);
    route_in_map.stations = std::move(order.stations);
    order_text = std::move(order.text);
  }
  return std::make_unique<GasMission>(settings.gas_mission, std::move(route_in_map), std::move(order_text));
}

void validate_goals(const std::vector<SavedGoal>& goals, const RobotDescription& robot, const Route& site_in_map) {
  if (std::none_of(goals.begin(), goals.end(), [](const SavedGoal& goal) { return goal.type == GoalType::kScan; }))
    return;
  if (!site_in_map.lining)
    throw InputError("stack.tunnel_mission: goal of type D requires a lining in the site survey");
  robot.T_body("scanner");
}

/// Refuses a mission that starts or ends in a dock of a site without one.
void require_dock(const TunnelMissionSettings& settings, const Route& site_in_map) {
  const bool starts_docked = settings.start_docked && !settings.start_at_survey;
  if (site_in_map.dock || (!settings.dock_after_run && !starts_docked)) return;
  throw InputError(fmt::format("stack.tunnel_mission.{} = true: requires a dock in the site survey{}",
                               settings.dock_after_run ? "dock_after_run" : "start_docked",
                               settings.dock_after_run && starts_docked ? ", and start_docked = true too" : ""));
}

std::unique_ptr<Mission> make_tunnel_mission(const StackSettings& settings, const RobotDescription& robot,
                                             const Route& site_in_map, const StackStart& start) {
  auto mission =
      std::make_unique<TunnelMission>(settings.tunnel_mission, start.goals, start.has_teleop, start.map.has_value());
  validate_goals(start.goals, robot, site_in_map);
  if (!start.map && !start.has_teleop && settings.localizer == "automatic") {
    throw InputError("stack.tunnel_mission: requires a map or a teleoperated mapping drive");
  }
  require_dock(settings.tunnel_mission, site_in_map);
  return mission;
}

std::unique_ptr<Mission> make_mission(const StackSettings& settings, const RobotDescription& robot,
                                      const Route& site_in_map, const StackStart& start) {
  if (is_tunnel(settings)) return make_tunnel_mission(settings, robot, site_in_map, start);
  return make_gas_mission(settings, robot, site_in_map, start.seed);
}

/// Makes every instrument that the robot carries and whose design data the survey contains.
InstrumentSet make_instruments(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                               StackStart& start) {
  validate(settings.inspection, "inspection");
  std::vector<std::unique_ptr<Instrument>> instruments;
  const auto has = [&](const char* frame) { return robot.T_body_sensor.contains(frame); };
  if (has("tdlas"))
    instruments.push_back(std::make_unique<GasInstrument>(gas_rules(settings.gas_mission), robot.T_body("tdlas")));
  if (has("scanner") && site_in_map.lining) {
    instruments.push_back(std::make_unique<LiningInstrument>(settings.inspection, *site_in_map.lining,
                                                             robot.T_body("scanner"), std::move(start.references)));
  }
  if (robot.antenna)
    instruments.push_back(std::make_unique<WaterInstrument>(settings.inspection.water, *robot.antenna, start.seed));
  return {std::move(instruments), settings.inspection.siren_duration_s};
}

}  // namespace

Stack make_stack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map,
                 StackStart start) {
  MotionExecutor motion(settings, robot, site_in_map, start.seed);
  std::unique_ptr<Mission> mission = make_mission(settings, robot, site_in_map, start);
  InstrumentSet instruments = make_instruments(settings, robot, site_in_map, start);
  LocalizerStart localizer{.map = std::move(start.map),
                           .map_registration = start.map_registration,
                           .has_mapping_drive = is_tunnel(settings) && start.has_teleop,
                           .neighbor_model = std::move(start.neighbor_model)};
  return Stack({.pose = PosePipeline(settings, robot, site_in_map, localizer, start.seed, start.site, start.has_thread),
                .motion = std::move(motion),
                .mission = std::move(mission),
                .instruments = std::move(instruments),
                .sensor_monitor = SensorMonitor(settings.sensor_monitor),
                .dock = site_in_map.dock,
                .site = SiteFollower(site_in_map, start.site.T_site_start, settings.registration.min_site_shift_m),
                .map_period_s = start.map_period_s});
}

}  // namespace patrol::stack
