#include "app/run/stack_documents.h"

#include <utility>

#include <fmt/format.h>

#include "core/wheel_kinematics.h"
#include "io/files/atomic_file.h"
#include "io/logs/run_log.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

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

/// Section of one key.
template <typename Value>
struct KnownKey {
  const char* name;
  const Value& value;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(self.name, self.value);
  }
};

/// Sensors that the robot has, without their error models.
struct KnownSensors {
  const sim::SensorSuiteSettings& sensors;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    auto visit_enabled = [&](const char* name, const auto& settings) {
      if constexpr (requires { settings.enabled; }) visit(name, KnownKey<bool>{"enabled", settings.enabled});
    };
    sim::SensorSuiteSettings::fields(self.sensors, visit_enabled);
  }
};

/// Documents of the teleoperation, without the simulated operator.
struct KnownTeleop {
  const TeleopSettings& teleop;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("route", self.teleop.route);
    visit("recorded", self.teleop.recorded);
  }
};

/// Drive on wheels: type and rollers.
struct KnownWheelDrive {
  const sim::WheelDriveSettings& drive;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("type", self.drive.type);
    visit("roller_pattern", self.drive.roller_pattern);
    visit("roller_angle_rad", self.drive.roller_angle_rad);
  }
};

/// Keys of a scenario that a robot's software may know.
struct KnownScenario {
  const Scenario& scenario;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    const Scenario& known = self.scenario;
    visit("version", known.version);
    visit("world", known.world);
    visit("robot", known.robot);
    visit("seed", known.seed);
    visit("mission", known.mission);
    visit("tour", known.tour);
    visit("map", known.map);
    visit("goals", known.goals);
    visit("references", known.references);
    visit("teleop", KnownTeleop{known.teleop});
    visit("mounts", known.mounts);
    visit("sensors", KnownSensors{known.sensors});
    visit("wheel_drive", KnownWheelDrive{known.wheel_drive});
    visit("stack", known.stack);
    visit("log", KnownKey<double>{"map_period_s", known.log.map_period_s});
  }
};

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
  std::vector<std::string> goals;
  for (const SavedGoal& goal : files.goals) goals.push_back(goal.name());
  return {files.route.station_names(), std::move(goals)};
}

}  // namespace

std::string known_settings(const Scenario& scenario) { return io::to_yaml(KnownScenario{scenario}); }

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
                .goals = scenario.goals.empty() ? "" : io::load_text(world / scenario.goals),
                .registration = files.map_registration ? io::load_text(registration_beside(world / scenario.map)) : "",
                .documents = known_settings(scenario)},
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
