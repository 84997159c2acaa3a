#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/common/print_result.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/scenario.h"
#include "app/scenario/sensor_needs.h"
#include "app/scoring/metric_infos.h"
#include "app/study/study_table.h"
#include "core/event.h"
#include "core/named_table.h"
#include "core/route.h"
#include "core/text.h"
#include "importer/output_folder.h"
#include "io/json/table_json.h"
#include "io/logs/topics.h"
#include "plan/routes/planners.h"
#include "slam/methods/mapper.h"

namespace patrol::app {
namespace {

/// File of a data folder.
struct DataFile {
  std::filesystem::path path;
  std::string name;    ///< path relative to the data folder
  std::string folder;  ///< name of the data folder
};

/// Files below `kind` ("worlds" or "models") of the data folders that `keep` accepts, sorted within each folder.
template <typename Keep>
std::vector<DataFile> data_files(const std::vector<DataFolder>& folders, const std::string& kind, const Keep& keep) {
  std::vector<DataFile> found;
  for (const DataFolder& folder : folders) {
    const auto first = static_cast<std::ptrdiff_t>(found.size());
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder.path / kind, ignored)) continue;
    auto iterator = std::filesystem::recursive_directory_iterator(folder.path / kind);
    for (const auto& entry : iterator) {
      if (entry.path().extension() == importer::kStagingExtension && entry.is_directory(ignored))
        iterator.disable_recursion_pending();
      // A link to itself is no regular file.
      if (!entry.is_regular_file(ignored) || !keep(entry.path())) continue;
      found.push_back({.path = entry.path(),
                       .name = std::filesystem::relative(entry.path(), folder.path).string(),
                       .folder = folder.name});
    }
    std::sort(found.begin() + first, found.end(), [](const DataFile& a, const DataFile& b) { return a.name < b.name; });
  }
  return found;
}

/// Named things of one kind, one per row.
struct Section {
  std::string title;
  io::Table table;  ///< its name is the key of the section in JSON
};

/// Section of names without further columns.
Section section(const std::string& title, const std::string& key, const std::vector<std::string>& names) {
  Section result{.title = title, .table = {.name = key, .columns = {"name"}, .rows = {}}};
  for (const std::string& name : names) result.table.rows.push_back({name});
  return result;
}

/// Section of a table's rows: names and their documentation.
template <NamedTable Table>
Section section(const std::string& title, const std::string& key, const Table& rows) {
  Section result{.title = title, .table = {.name = key, .columns = {"name", "summary"}, .rows = {}}};
  for (const auto& row : rows) result.table.rows.push_back({std::string(row.name), std::string(row.summary)});
  return result;
}

std::string text_of(const io::TableValue& value) {
  if (const double* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const std::string* text = std::get_if<std::string>(&value)) return *text;
  return "";
}

/// Title and rows, in columns.
std::string to_text(const Section& section) {
  std::vector<std::size_t> widths(section.table.columns.size(), 0);
  for (const auto& row : section.table.rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i) widths[i] = std::max(widths[i], text_of(row[i]).size());
  }
  std::string text = section.title + "\n";
  for (const auto& row : section.table.rows) {
    text += " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format(" {:<{}}", text_of(row[i]), widths[i]) + (i + 1 < row.size() ? " " : "");
    text += "\n";
  }
  return text;
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

Section sensor_section() {
  Section result{.title = "sensors",
                 .table = {.name = "sensors", .columns = {"name", "topic", "type", "summary"}, .rows = {}}};
  for (const SensorInfo& info : kSensorInfos) {
    result.table.rows.push_back(
        {std::string(info.name), std::string(info.topic), std::string(info.ros_type), std::string(info.summary)});
  }
  return result;
}

Section topic_section() {
  Section result{.title = "topics of a log",
                 .table = {.name = "topics", .columns = {"topic", "type", "source", "summary"}, .rows = {}}};
  for (const io::TopicInfo& info : io::topic_infos())
    result.table.rows.push_back({info.topic, info.type, info.source, info.summary});
  return result;
}

Section metric_section() {
  Section result{.title = "metrics (metrics.json, expect, --metric)",
                 .table = {.name = "metrics", .columns = {"name", "summary"}, .rows = {}}};
  for (const MetricInfo& info : metric_infos()) result.table.rows.push_back({info.path, info.summary});
  return result;
}

/// Visitor that collects the tolerances of section `as_built` with their defaults, and their sources.
struct ToleranceSections {
  Section tolerances{.title = "as-built tolerances (as_built): defaults",
                     .table = {.name = "as_built_tolerances", .columns = {"name", "default"}, .rows = {}}};
  Section sources{.title = "sources of the as-built tolerances",
                  .table = {.name = "as_built_sources", .columns = {"name", "source"}, .rows = {}}};
  std::string group;
  template <typename Value>
  void operator()(const char* name, const Value& value, const Limits& = {}) {
    const std::string key = group.empty() ? name : fmt::format("{}.{}", group, name);
    if constexpr (requires { Value::kSource; }) {
      const std::string outer = std::exchange(group, key);
      sources.table.rows.push_back({key, std::string(Value::kSource)});
      Value::fields(value, *this);
      group = outer;
    } else {
      tolerances.table.rows.push_back({key, fmt::format("{}", value)});
    }
  }
};

/// Robot of a scenario and the sensors that it needs; the message of a scenario that is refused.
std::pair<std::string, std::string> robot_and_needs_of(const std::filesystem::path& file) {
  try {
    const Scenario scenario = load_scenario(file);
    std::vector<std::string> sensors;
    for (const SensorNeed& need : sensor_needs(scenario, load_scenario_files(scenario, find_data_root(file))))
      sensors.push_back(need.sensor);
    return {scenario.robot, join(sensors, ", ")};
  } catch (const InputError& error) {
    return {"refused", error.what()};
  }
}

/// Section of the scenarios; without rows if `has_rows` is false, as the rows load every scenario.
Section scenario_section(const std::vector<DataFolder>& folders, bool has_rows) {
  Section result{.title = "scenarios, their robots, the sensors that they need and their folders",
                 .table = {.name = "scenarios", .columns = {"name", "robot", "needed_sensors", "folder"}, .rows = {}}};
  if (!has_rows) return result;
  const auto is_scenario = [](const auto& file) { return file.parent_path().filename() == "scenarios"; };
  for (const DataFile& file : data_files(folders, "worlds", is_scenario)) {
    const auto [robot, needs] = robot_and_needs_of(file.path);
    result.table.rows.push_back({file.name, robot, needs, file.folder});
  }
  return result;
}

Section file_section(const std::string& name, const std::vector<DataFile>& files) {
  Section result{.title = name + " and their folders",
                 .table = {.name = name, .columns = {"name", "folder"}, .rows = {}}};
  for (const DataFile& file : files) result.table.rows.push_back({file.name, file.folder});
  return result;
}

/// Adds scenarios, worlds and robots; an explanation if the data folder is missing.
void add_data(bool has_scenarios, std::vector<Section>& sections) {
  std::vector<DataFolder> folders;
  try {
    folders = data_folders();
  } catch (const InputError& error) {
    fmt::print(stderr, "patrol: no scenarios, worlds and robots: {}\n", error.what());
    return;
  }
  sections.push_back(scenario_section(folders, has_scenarios));
  sections.push_back(file_section("worlds", data_files(folders, "worlds", [](const auto& file) {
                                    return file.extension() == ".xml" && file.stem() == file.parent_path().filename();
                                  })));
  sections.push_back(file_section(
      "robots", data_files(folders, "models", [](const auto& file) { return file.extension() == ".urdf"; })));
}

/// All sections; the scenarios have rows only if `wanted` is their section or none.
std::vector<Section> all_sections(const std::optional<std::string>& wanted) {
  std::vector<Section> sections;
  add_data(wanted.value_or("scenarios") == "scenarios", sections);
  sections.push_back(sensor_section());
  sections.push_back(section("lidar presets", "lidar_presets", allowed<LidarSettings>("preset")));
  ToleranceSections tolerances;
  const Scenario defaults;
  sim::AsBuiltSettings::fields(defaults.as_built, tolerances);
  sections.push_back(tolerances.tolerances);
  sections.push_back(tolerances.sources);
  sections.push_back(section("sensor faults", "sensor_faults", allowed<sim::FaultSettings>("kind")));
  sections.push_back(section("odometry sources (stack.odometry_source)", "odometry_sources",
                             allowed<stack::StackSettings>("odometry_source")));
  sections.push_back(section("localizers (stack.localizer)", "localizers", allowed<stack::StackSettings>("localizer")));
  sections.push_back(
      section("missions (stack.mission_type)", "missions", allowed<stack::StackSettings>("mission_type")));
  sections.push_back(
      section("SLAM methods (stack.slam.method; patrol slam --method)", "slam_methods", slam::mapping_methods()));
  sections.push_back(
      section("odometry of method rbpf (stack.slam.rbpf.odometry)", "rbpf_odometries", slam::kRbpfOdometries));
  sections.push_back(
      section("particle optimizers (stack.slam.rbpf.optimizer)", "particle_optimizers", slam::optimizers()));
  sections.push_back(section("particle resamplers", "particle_resamplers", slam::resamplers()));
  sections.push_back(section("localization methods", "localization_methods",
                             {"Monte Carlo localization with KLD sampling (stack.localization)"}));
  sections.push_back(section("sensor models of localization (stack.localization.sensor_model)", "sensor_models",
                             localize::sensor_models()));
  sections.push_back(section("global planners (stack.navigation.global_planner.method; patrol plan --planner)",
                             "global_planners", plan::route_planners()));
  sections.push_back(
      section("local planners (stack.navigation.local_planner.method)", "local_planners", plan::local_planners()));
  sections.push_back(section("station types (mission)", "station_types", kStationTypes));
  sections.push_back(section("goal types (goals; stack.tunnel_mission.goal_types)", "goal_types", kGoalTypes));
  sections.push_back(section("event kinds", "event_kinds", std::span(kEventKinds).subspan(1)));  // without foreign ones
  sections.push_back(topic_section());
  sections.push_back(metric_section());
  sections.push_back(section("studies", "studies", study_names()));
  return sections;
}

}  // namespace

ExitCode list_command(const ListOptions& options) {
  std::string text;
  io::Metrics json = io::Metrics::object();
  std::vector<std::string> known;
  for (const Section& section : all_sections(options.section)) {
    known.push_back(section.table.name);
    if (options.section && *options.section != section.table.name) continue;
    text += to_text(section);
    json[section.table.name] = io::to_json(section.table);
  }
  if (json.empty())
    throw InputError(fmt::format("unknown section '{}' (known: {})", *options.section, join(known, ", ")));
  print_result(options.form, text, json);
  return ExitCode::kDone;
}

}  // namespace patrol::app
