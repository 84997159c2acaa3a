#include "app/run/stack_documents.h"

#include <fstream>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "io/logs/run_log.h"

namespace patrol::app {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), {}};
}

link::VelocityLimits limits_of(const Scenario& scenario, const RobotDescription& robot) {
  const sim::LocomotionSettings& legs = scenario.locomotion;
  const auto along = [](double speed_mps, double yaw_rate_radps) {
    return link::VelocityLimits{
        .forward_mps = speed_mps, .backward_mps = speed_mps, .sideways_mps = 0.0, .yaw_rate_radps = yaw_rate_radps};
  };
  if (robot.tracks) return along(scenario.track_drive.max_speed_mps, scenario.track_drive.max_yaw_rate_radps);
  if (!robot.wheels.empty()) {
    link::VelocityLimits limits = along(scenario.wheel_drive.max_speed_mps, scenario.wheel_drive.max_yaw_rate_radps);
    if (has_rollers(robot)) limits.sideways_mps = scenario.wheel_drive.max_lateral_speed_mps;
    return limits;
  }
  return {.forward_mps = legs.max_forward_mps,
          .backward_mps = legs.max_backward_mps,
          .sideways_mps = legs.max_sideways_mps,
          .yaw_rate_radps = legs.max_yaw_rate_radps};
}

/// Sets which sensors the robot has; their error models are not documented.
void document_sensors(const sim::SensorSuiteSettings& sensors, sim::SensorSuiteSettings& documented) {
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      auto& own = documented.*SensorTraits<Message>::kSettings;
      if constexpr (requires { own.enabled; }) own.enabled = sim::is_enabled<Message>(sensors);
    }
  });
}

/// Topics of the commands to instruments that the robot lacks. Every robot can have a warning light: it is not
/// simulated.
std::set<std::string> topics_without_instrument(const sim::SensorSuiteSettings& sensors,
                                                const RobotDescription& robot) {
  std::set<std::string> topics;
  if (!sensors.scanner.enabled) topics.insert(io::kTopic<ScanCommand>);
  if (!robot.antenna) topics.insert(io::kTopic<AntennaCommand>);
  if (!sensors.tem.enabled) topics.insert(io::kTopic<SoundingCommand>);
  return topics;
}

EventSubjects subjects_of(const ScenarioFiles& files) {
  std::vector<std::string> stations, goals;
  for (const Station& station : files.route.stations) stations.push_back(station.name);
  for (const SavedGoal& goal : files.goals) goals.push_back(fmt::format("goal_{}", goal.number));
  return {std::move(stations), std::move(goals)};
}

}  // namespace

Scenario documented_scenario(const Scenario& scenario) {
  Scenario documented;
  documented.version = scenario.version;
  documented.world = scenario.world;
  documented.robot = scenario.robot;
  documented.seed = scenario.seed;
  documented.mission = scenario.mission;
  documented.tour = scenario.tour;
  documented.map = scenario.map;
  documented.goals = scenario.goals;
  documented.references = scenario.references;
  documented.teleop.route = scenario.teleop.route;
  documented.teleop.recorded = scenario.teleop.recorded;
  documented.mounts = scenario.mounts;
  documented.wheel_drive.type = scenario.wheel_drive.type;
  documented.wheel_drive.roller_pattern = scenario.wheel_drive.roller_pattern;
  documented.wheel_drive.roller_angle_rad = scenario.wheel_drive.roller_angle_rad;
  document_sensors(scenario.sensors, documented.sensors);
  documented.stack = scenario.stack;
  documented.log.map_period_s = scenario.log.map_period_s;
  return documented;
}

StackDocuments stack_documents(const Scenario& scenario, const std::string& name, const ScenarioFiles& files,
                               const std::filesystem::path& data_root, Time tick) {
  const std::filesystem::path world = files.world_xml.parent_path();
  StackDocuments documents{
      .hello = {.program = fmt::format("patrol {}", PATROL_VERSION),
                .scenario = name,
                .seed = scenario.seed,
                .tick = tick,
                .limits = limits_of(scenario, files.robot),
                .robot = files.robot_urdf_text,
                .site = files.mission_text,
                .goals = scenario.goals.empty() ? "" : text_of(world / scenario.goals),
                .registration = files.map_registration ? text_of(registration_beside(world / scenario.map)) : "",
                .documents = to_yaml(documented_scenario(scenario))},
      .environment = {{"PATROL_DATA", data_root.string()}},
      .static_transforms = io::encode(io::sensor_mounts(files.robot)),
      .known_map = {},
      .recorded = {},
      .unanswered = topics_without_instrument(scenario.sensors, files.robot),
      .subjects = subjects_of(files)};
  if (files.map) documents.known_map = io::encode(MapUpdate{.stamp = {}, .map = *files.map});
  return documents;
}

}  // namespace patrol::app
