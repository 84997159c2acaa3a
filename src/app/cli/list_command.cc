#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/cli/commands.h"
#include "app/scenario/scenario.h"
#include "app/study/study_table.h"
#include "core/event.h"
#include "core/named_table.h"
#include "core/route.h"
#include "plan/routes/planners.h"
#include "slam/methods/mapper.h"

namespace patrol::app {
namespace {

/// Files below `folder` that `keep` accepts, as paths relative to `root`, sorted.
template <typename Keep>
std::vector<std::string> files_below(const std::filesystem::path& root, const std::string& folder, const Keep& keep) {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    std::error_code ignored;  // a link to itself
    if (entry.is_regular_file(ignored) && keep(entry.path()))
      found.push_back(std::filesystem::relative(entry.path(), root).string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void print(const char* title, const std::vector<std::string>& lines) {
  fmt::print("{}\n", title);
  for (const std::string& line : lines) fmt::print("  {}\n", line);
}

/// Prints the names of a table's rows with their documentation.
template <NamedTable Table>
void print_table(const char* title, const Table& table) {
  std::size_t width = 0;
  for (const auto& row : table) width = std::max(width, row.name.size());
  fmt::print("{}\n", title);
  for (const auto& row : table) fmt::print("  {:<{}}  {}\n", row.name, width, row.summary);
}

/// Visitor that collects the allowed values of one settings field.
struct AllowedValues {
  std::string wanted;
  std::vector<std::string> values;
  template <typename Value>
  void operator()(const char* name, Value&, const Limits& limits = {}) {
    if (name == wanted) values = limits.allowed;
  }
};

template <typename Settings>
std::vector<std::string> allowed(const std::string& field) {
  AllowedValues visitor{.wanted = field, .values = {}};
  const Settings settings;
  Settings::fields(settings, visitor);
  return visitor.values;
}

/// Name, topic, type and documentation of each registered sensor.
std::vector<std::string> sensor_lines() {
  std::vector<std::string> lines;
  for (const SensorInfo& info : kSensorInfos) {
    lines.push_back(fmt::format("{:<15} {:<16} {:<29} {}", info.name, info.topic, info.ros_type, info.summary));
  }
  return lines;
}

/// Visitor that collects the tolerances of section `as_built` with their defaults and sources.
struct ToleranceLines {
  std::vector<std::string> lines;
  std::string group;
  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    if constexpr (requires { Value::kSource; }) {
      group = name;
      lines.push_back(fmt::format("{}: {}", name, Value::kSource));
      Value::fields(value, *this);
    } else {
      lines.push_back(fmt::format("  {:<45} {}", group.empty() ? name : fmt::format("{}.{}", group, name), value));
    }
  }
};

std::vector<std::string> tolerance_lines() {
  ToleranceLines visitor;
  const Scenario defaults;
  sim::AsBuiltSettings::fields(defaults.as_built, visitor);
  return std::move(visitor.lines);
}

/// Prints scenarios, worlds and robots; a hint if the data folder is missing.
void print_data() {
  std::filesystem::path root;
  try {
    root = find_data_root("");
  } catch (const InputError& error) {
    fmt::print("scenarios, worlds, robots\n  none: {}\n", error.what());
    return;
  }
  print("scenarios",
        files_below(root, "worlds", [](const auto& file) { return file.parent_path().filename() == "scenarios"; }));
  print("worlds", files_below(root, "worlds", [](const auto& file) {
          return file.extension() == ".xml" && file.stem() == file.parent_path().filename();
        }));
  print("robots", files_below(root, "models", [](const auto& file) { return file.extension() == ".urdf"; }));
}

}  // namespace

ExitCode list_command() {
  print_data();
  print("sensors", sensor_lines());
  print("lidar presets", allowed<LidarSettings>("preset"));
  print("as-built tolerances (as_built)", tolerance_lines());
  print("sensor faults", allowed<sim::FaultSettings>("kind"));
  print("odometry sources (stack.odometry_source)", allowed<stack::StackSettings>("odometry_source"));
  print("localizers (stack.localizer)", allowed<stack::StackSettings>("localizer"));
  print("missions (stack.mission_type)", allowed<stack::StackSettings>("mission_type"));
  print_table("SLAM methods (stack.slam.method; patrol slam --method)", slam::mapping_methods());
  print_table("odometry of method rbpf (stack.slam.rbpf.odometry)", slam::kRbpfOdometries);
  print_table("particle optimizers (stack.slam.rbpf.optimizer)", slam::optimizers());
  print_table("particle resamplers", slam::resamplers());
  print("localization methods", {"Monte Carlo localization with KLD sampling (stack.localization)"});
  print_table("sensor models of localization (stack.localization.sensor_model)", localize::sensor_models());
  print_table("global planners (stack.navigation.global_planner.method; patrol plan --planner)",
              plan::route_planners());
  print_table("local planners (stack.navigation.local_planner.method)", plan::local_planners());
  print_table("station types (mission)", kStationTypes);
  print_table("goal types (goals; stack.tunnel_mission.goal_types)", kGoalTypes);
  print_table("event kinds", std::span(kEventKinds).subspan(1));  // without foreign kinds
  print("studies", study_names());
  return ExitCode::kDone;
}

}  // namespace patrol::app
