#include "app/scenario/sensor_needs.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace patrol::app {
namespace {

const SensorInfo* find_sensor(std::string_view name) {
  const auto* const info = std::ranges::find_if(kSensorInfos, [&](const SensorInfo& one) { return name == one.name; });
  return info == kSensorInfos.end() ? nullptr : info;
}

void add(std::vector<SensorNeed>& needs, const std::string& sensor, const std::string& by) {
  const auto known = std::ranges::find(needs, sensor, &SensorNeed::sensor);
  if (known == needs.end()) needs.push_back({.sensor = sensor, .by = by});
  else known->by += ", " + by;
}

/// Adds the needs of the built-in stack.
void add_stack_needs(const Scenario& scenario, const ScenarioFiles& files, std::vector<SensorNeed>& needs) {
  const stack::StackSettings& stack = scenario.stack;
  const bool has_map = files.map.has_value() || stack.localizer == "monte_carlo";
  add(needs, "lidar", has_map ? "stack.localization" : "stack.slam");
  if (stack.odometry_source != "legged") add(needs, "imu", "stack.odometry_source");
  const bool inspects = std::ranges::any_of(
      files.route.stations, [](const Station& station) { return station.type == StationType::kInspect; });
  if (stack.mission_type != "tunnel" && inspects) add(needs, "tdlas", "mission");
  const bool scans =
      std::ranges::any_of(files.goals, [](const SavedGoal& goal) { return goal.type == GoalType::kScan; });
  if (stack.mission_type == "tunnel" && scans) add(needs, "scanner", "goals");
}

}  // namespace

std::vector<SensorNeed> firmware_needs(const RobotDescription& robot) {
  const char* const drive = robot.tracks ? "track_drive" : robot.wheels.empty() ? "locomotion" : "wheel_drive";
  return {{.sensor = "imu", .by = drive}};
}

std::vector<SensorNeed> sensor_needs(const Scenario& scenario, const ScenarioFiles& files) {
  std::vector<SensorNeed> needs;
  if (scenario.stack.command.empty()) add_stack_needs(scenario, files, needs);
  for (const SensorNeed& need : firmware_needs(files.robot)) add(needs, need.sensor, need.by);
  for (std::size_t i = 0; i < scenario.faults.size(); ++i) {
    const SensorInfo* info = find_sensor(scenario.faults[i].sensor);
    if (info != nullptr && *info->frame != '\0') add(needs, info->name, fmt::format("faults.{}", i));
  }
  for (const SensorNeed& need : scenario.requested) add(needs, need.sensor, need.by);
  return needs;
}

void require_sensors(const std::vector<SensorNeed>& needs, const RobotDescription& robot, const std::string& robot_name,
                     const std::string& location) {
  std::vector<std::string> missing, frames;
  for (const SensorNeed& need : needs) {
    const SensorInfo* info = find_sensor(need.sensor);
    if (info == nullptr || *info->frame == '\0' || robot.T_body_sensor.contains(info->frame)) continue;
    missing.push_back(fmt::format("{}no {} ({}), which {} require{}", missing.empty() ? "" : "and ", need.sensor,
                                  info->summary, need.by, need.by.find(", ") == std::string::npos ? "s" : ""));
    if (std::ranges::find(frames, info->frame) == frames.end()) frames.emplace_back(info->frame);
  }
  if (missing.empty()) return;
  throw InputError(fmt::format(
      "{}: {} has {}; add {} (models/{}/{}.yaml, mounts)", location, robot_name, join(missing, ", "),
      frames.size() == 1 ? "a mount of the frame " + frames.front() : "mounts of the frames " + join(frames, ", "),
      robot_name, robot_name));
}

std::vector<std::string> absent_sensors(const RobotDescription& robot, const sim::SensorSuiteSettings& sensors) {
  std::vector<std::string> absent;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    constexpr const SensorInfo& kInfo = SensorTraits<Message>::kInfo;
    if (*kInfo.frame != '\0' && sim::is_enabled<Message>(sensors) && !robot.T_body_sensor.contains(kInfo.frame))
      absent.emplace_back(kInfo.name);
  });
  return absent;
}

void disable_absent_sensors(const RobotDescription& robot, const std::vector<std::string>& enabled_by_name,
                            Scenario& scenario) {
  for (const std::string& sensor : absent_sensors(robot, scenario.sensors)) {
    if (std::ranges::find(enabled_by_name, sensor) != enabled_by_name.end()) {
      scenario.requested.push_back({.sensor = sensor, .by = fmt::format("sensors.{}.enabled", sensor)});
      continue;
    }
    Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
      if constexpr (HasSensorSettings<Message>) {
        auto& own = scenario.sensors.*SensorTraits<Message>::kSettings;
        if constexpr (requires { own.enabled; }) {
          if (sensor == SensorTraits<Message>::kInfo.name) own.enabled = false;
        }
      }
    });
  }
}

}  // namespace patrol::app
