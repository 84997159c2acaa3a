#include "app/run/make_simulator.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "app/scenario/mounts.h"
#include "core/error.h"
#include "core/geometry/angles.h"
#include "render/scene/depth_renderer.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

sim::SimulatorSettings simulator_settings(const Scenario& scenario, const ScenarioFiles& files) {
  return {.world_xml = files.world_xml.string(),
          .site = files.site,
          .robot_urdf = files.simulated_robot(),
          .T_world_start = start_in_world(scenario, files),
          .as_built = scenario.as_built,
          .sensors = scenario.sensors,
          .locomotion = scenario.locomotion,
          .track_drive = scenario.track_drive,
          .wheel_drive = scenario.wheel_drive,
          .static_obstacles = all_static_obstacles(scenario),
          .lining = files.route.lining,  // site is world
          .lining_deformations = scenario.lining_deformation,
          .actors = scenario.actors,
          .leaks = scenario.leaks,
          .wind = scenario.wind,
          .subsurface = {.rock = scenario.rock, .water_bodies = scenario.water_bodies},
          .faults = scenario.faults,
          .teleop_route = files.teleop_route,
          .teleop_operator = scenario.teleop.teleop_operator,
          .recorded = files.recorded};
}

}  // namespace

Pose2 start_in_world(const Scenario& scenario, const ScenarioFiles& files) {
  return files.T_site_start * Pose2{scenario.start.ahead_m, scenario.start.left_m, to_rad(scenario.start.yaw_deg)};
}

std::vector<sim::StaticObstacleSettings> all_static_obstacles(const Scenario& scenario) {
  std::vector<sim::StaticObstacleSettings> obstacles = scenario.static_obstacles;
  const std::vector<sim::StaticObstacleSettings> scattered =
      sim::scatter_low_obstacles(scenario.low_obstacles, scenario.seed);
  obstacles.insert(obstacles.end(), scattered.begin(), scattered.end());
  return obstacles;
}

sim::Simulator make_simulator(const Scenario& scenario, const ScenarioFiles& files, bool has_sensor_thread) {
  sim::SimulatorSettings settings = simulator_settings(scenario, files);
  settings.has_sensor_thread = has_sensor_thread;
  return with_location(
      scenario, [&] { return sim::Simulator(settings, files.robot, scenario.seed, render::make_depth_renderer); });
}

void check_kidnaps(const Scenario& scenario, const ScenarioFiles& files) {
  constexpr std::string_view kStart = "start pose ";
  for (std::size_t i = 0; i < scenario.kidnaps.size(); ++i) {
    const KidnapSettings& kidnap = scenario.kidnaps[i];
    try {
      sim::assemble_model(files.world_xml.string(), files.simulated_robot(), files.robot,
                          {kidnap.x_m, kidnap.y_m, to_rad(kidnap.heading_deg)}, all_static_obstacles(scenario),
                          sim::Textures::kNone);
    } catch (const InputError& error) {
      std::string text = error.what();
      if (text.starts_with(kStart)) text.erase(0, kStart.size());
      throw InputError(with_location_of_key(scenario, fmt::format("kidnaps.{}: {}", i, text)));
    }
  }
}

}  // namespace patrol::app
