#include "app/scenario/scenario.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/scenario/data_folders.h"
#include "app/scenario/lidar_preset.h"
#include "app/scenario/mounts.h"
#include "app/scenario/neighbor_model.h"
#include "app/scenario/sensor_needs.h"
#include "core/error.h"
#include "io/files/teleop_csv.h"
#include "io/json/nav_json.h"
#include "io/json/registration_json.h"
#include "io/json/route_json.h"
#include "io/json/teleop_route_json.h"
#include "io/maps/map_server.h"
#include "io/urdf.h"
#include "io/yaml/settings_yaml.h"
#include "sim/leg_scale.h"
#include "sim/locomotion/locomotion_settings.h"
#include "sim/locomotion/roller_contact.h"
#include "sim/sensors/uwb.h"
#include "stack/mission/known_map.h"

namespace patrol::app {
namespace {

/// Settings of a world; the defaults if it has none.
sim::SiteSettings site_settings_of(const std::filesystem::path& world_xml) {
  const std::filesystem::path file = std::filesystem::path(world_xml).replace_extension(".yaml");
  return std::filesystem::exists(file) ? io::load_settings<sim::SiteSettings>(file, {}) : sim::SiteSettings{};
}

/// Path of a file below the world's folder that a key names. Throws InputError if it does not exist.
std::filesystem::path find_named_file(const std::filesystem::path& world, const char* key, const std::string& name) {
  std::filesystem::path file = world / name;
  if (!std::filesystem::exists(file)) throw InputError(fmt::format("{} = {}: {} not found", key, name, file.string()));
  if (std::filesystem::is_directory(file))
    throw InputError(fmt::format("{} = {}: {} is a folder", key, name, file.string()));
  return file;
}

/// Returns whether an override sets a key or a part of it. Overrides have no lines.
bool is_overridden(const std::string& key, const std::vector<std::string>& overrides) {
  return std::ranges::any_of(overrides, [&](const std::string& one) {
    return one.starts_with(key) && (one.substr(key.size()).starts_with("=") || one.substr(key.size()).starts_with("."));
  });
}

/// Returns a document of which the messages contain the lines; empty if an override sets the key.
YAML::Node lines_of(const std::filesystem::path& file, const std::string& key,
                    const std::vector<std::string>& overrides) {
  return is_overridden(key, overrides) ? YAML::Node() : io::load_document(file, {});
}

/// Loads the document of a scenario or a robot profile, with the values of preset files in place of their names.
YAML::Node load_with_presets(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  YAML::Node document = io::load_document(file, overrides);
  expand_lidar_presets(file, document);
  return document;
}

/// Reads a scenario or a robot profile over the values in `settings`. Mounts of the file switch their sensors on before
/// the settings of the sensors are read, and extend the mounts in `settings`. If the file selects another lidar, the
/// as-built tolerances of that lidar are the defaults.
template <typename Settings>
void read_over(const std::filesystem::path& file, const std::vector<std::string>& overrides, Settings& settings) {
  const std::string preset = settings.sensors.lidar.preset;
  const std::vector<MountSettings> inherited = std::exchange(settings.mounts, {});
  const YAML::Node document = load_with_presets(file, overrides);
  const auto read_document = [&](Settings& into) {
    io::SettingsReader::read_section({file.string(), overrides}, document, "", into);
  };
  Settings read = settings;
  read_document(read);
  std::vector<MountSettings> mounts = std::move(read.mounts);
  complete_mounts(file, lines_of(file, "mounts", overrides), mounts);
  for (const MountSettings& mount : mounts) mount_sensor(mount, settings.sensors);
  read = settings;
  read_document(read);
  if (read.sensors.lidar.preset != preset) {
    settings.as_built.lidar = sim::LidarTolerances::for_preset(read.sensors.lidar.preset);
    read = settings;
    read_document(read);
  }
  read.mounts = merge_mounts(inherited, mounts);
  settings = std::move(read);
}

/// Returns the settings with which the profile of a robot starts: those that depend on its size.
RobotProfile profile_of_size(const RobotDescription& robot) {
  RobotProfile profile;
  if (robot.legs.empty()) return profile;
  profile.locomotion = sim::scaled_locomotion(robot);
  profile.stack.navigation.local_planner.dwa.max_speed_mps *=
      profile.locomotion.max_forward_mps / sim::LocomotionSettings{}.max_forward_mps;
  const double force = sim::leg_scale(robot).force;
  localize::LeggedOdometrySettings& odometry = profile.stack.odometry.legged;
  for (double* force_n : {&odometry.contact_on_force_n, &odometry.contact_off_force_n, &odometry.full_weight_force_n,
                          &profile.sensors.foot_contact.range_n}) {
    *force_n *= force;
  }
  return profile;
}

/// The robot's profile, if it has one, over the defaults for the size of the robot.
Scenario scenario_of_profile(const std::filesystem::path& profile_file, const std::filesystem::path& urdf_file) {
  RobotProfile profile =
      std::filesystem::exists(urdf_file) ? profile_of_size(io::load_robot_description(urdf_file)) : RobotProfile{};
  if (std::filesystem::exists(profile_file)) read_over(profile_file, {}, profile);
  Scenario scenario;
  scenario.mounts = std::move(profile.mounts);
  scenario.as_built = profile.as_built;
  scenario.sensors = profile.sensors;
  scenario.locomotion = profile.locomotion;
  scenario.track_drive = profile.track_drive;
  scenario.wheel_drive = profile.wheel_drive;
  scenario.stack = profile.stack;
  return scenario;
}

/// Refuses a profile that enables a sensor without a frame of the robot, or disables a sensor that it mounts.
void check_profile(const std::filesystem::path& profile_file, const RobotDescription& robot,
                   const Scenario& of_profile) {
  if (!std::filesystem::exists(profile_file)) return;
  const YAML::Node document = io::load_document(profile_file, {});
  for (const std::string& sensor : absent_sensors(robot, of_profile.sensors)) {
    const YAML::Node enabled = find_node(document, {"sensors", sensor, "enabled"});
    if (!enabled.IsDefined()) continue;
    throw InputError(fmt::format("{} = true: the robot has no frame of this sensor: add a mount (mounts)",
                                 location_of(profile_file, enabled, fmt::format("sensors.{}.enabled", sensor))));
  }
  for (const MountSettings& mount : of_profile.mounts) {
    for (const std::string& sensor : sensors_of(mount)) {
      const YAML::Node enabled = find_node(document, {"sensors", sensor, "enabled"});
      if (!enabled.IsDefined() || enabled.as<bool>(true)) continue;
      throw InputError(
          fmt::format("{} = false: mounts of the same file have the frame {}, which switches the sensor "
                      "on: only one of both is allowed",
                      location_of(profile_file, enabled, fmt::format("sensors.{}.enabled", sensor)), mount.frame));
    }
  }
}

/// Returns the sensors that a document enables by name.
std::vector<std::string> enabled_by_name(const YAML::Node& document) {
  std::vector<std::string> names;
  for (const std::string& sensor : sensor_names()) {
    if (find_node(document, {"sensors", sensor, "enabled"}).IsDefined()) names.push_back(sensor);
  }
  return names;
}

/// Returns whether the MJCF of a world names UWB anchors; true if there is no such world.
bool has_uwb_anchors(const std::string& world, const std::filesystem::path& data_root) {
  const std::filesystem::path xml = world_folder(world, data_root) / (world + ".xml");
  return !std::filesystem::exists(xml) || io::load_text(xml).find(sim::kUwbAnchor) != std::string::npos;
}

/// Returns the robot with its mounts; none if it has no URDF.
std::optional<RobotDescription> robot_of(const std::string& name, const std::filesystem::path& data_root,
                                         const std::vector<MountSettings>& mounts) {
  if (!std::filesystem::exists(robot_file(name, ".urdf", data_root))) return std::nullopt;
  return load_robot(name, data_root, mounts).description;
}

/// Returns the file with the registration of a map to the site; none if there is none beside the map.
std::optional<std::filesystem::path> registration_of(const std::filesystem::path& map_yaml) {
  const std::filesystem::path file = registration_beside(map_yaml);
  return std::filesystem::exists(file) ? std::optional(file) : std::nullopt;
}

/// Loads the mission of a scenario: that of its file, or its tour.
void load_mission(const Scenario& scenario, ScenarioFiles& files) {
  if (!scenario.tour.stations.empty()) {
    if (!scenario.mission.empty())
      throw InputError("mission and tour are mutually exclusive: only one of them is allowed");
    files.route = route_of(scenario.tour);
    files.T_site_start = scenario.tour.start.pose();
    files.mission_text = io::to_json_text(files.route, files.T_site_start);
    return;
  }
  if (scenario.mission.empty()) throw InputError("mission: missing: name a mission file, or give tour.stations");
  const std::filesystem::path file = find_named_file(files.world_xml.parent_path(), "mission", scenario.mission);
  const io::RouteFile route = io::load_route(file);
  files.mission_text = io::load_text(file);
  files.route = route.route;
  files.T_site_start = route.T_site_start;
  files.datum = route.datum;
}

/// Loads the mission of a scenario and no other file of it.
ScenarioFiles load_mission_alone(const Scenario& scenario, const std::filesystem::path& data_root) {
  return with_location(scenario, [&] {
    ScenarioFiles files;
    files.world_xml = load_site(scenario.world, data_root).world_xml;
    load_mission(scenario, files);
    return files;
  });
}

/// Checks that the simulated receiver measures relative to the datum of the survey.
void check_datum(const Scenario& scenario, const ScenarioFiles& files) {
  const GnssSettings& gnss = scenario.sensors.gnss;
  if (!files.datum || !gnss.enabled || !files.robot.T_body_sensor.contains("gnss")) return;
  if (gnss.datum_latitude_deg == files.datum->latitude_deg && gnss.datum_longitude_deg == files.datum->longitude_deg)
    return;
  throw InputError(fmt::format(
      "sensors.gnss: datum_latitude_deg and datum_longitude_deg are {} and {}: must be those "
      "of the mission's datum, {} and {}",
      gnss.datum_latitude_deg, gnss.datum_longitude_deg, files.datum->latitude_deg, files.datum->longitude_deg));
}

/// Loads the files of a scenario; errors have no location.
ScenarioFiles load_files(const Scenario& scenario, const std::filesystem::path& data_root) {
  ScenarioFiles files;
  LoadedSite site = load_site(scenario.world, data_root);
  files.world_xml = std::move(site.world_xml);
  files.site = std::move(site.settings);
  LoadedRobot robot = load_robot(scenario.robot, data_root, scenario.mounts);
  files.robot_urdf = std::move(robot.urdf_file);
  files.robot_urdf_text = std::move(robot.urdf);
  files.robot = std::move(robot.description);
  sim::set_drive_type(scenario.wheel_drive, files.robot);
  const auto named_file = [&](const char* key, const std::string& name) {
    return find_named_file(files.world_xml.parent_path(), key, name);
  };
  load_mission(scenario, files);
  check_datum(scenario, files);
  if (!scenario.map.empty()) {
    const std::filesystem::path file = named_file("map", scenario.map);
    files.map = io::load_map(file);
    stack::validate_map(file.string(), *files.map);
    if (const auto registration = registration_of(file)) files.map_registration = io::load_registration(*registration);
  }
  if (!scenario.goals.empty()) {
    const std::filesystem::path file = named_file("goals", scenario.goals);
    files.goals = io::load_nav(file);
    stack::validate_goals(file.string(), files.goals, files.map);
  }
  require_sensors(sensor_needs(scenario, files), files.robot, scenario.robot,
                  scenario.robot_location.empty() ? "robot" : scenario.robot_location);
  files.neighbor_model = load_neighbor_model(scenario.stack.slam.method, data_root);
  if (!scenario.references.empty()) {
    const std::filesystem::path folder = files.world_xml.parent_path() / scenario.references;
    if (!std::filesystem::is_directory(folder))
      throw InputError(fmt::format("references = {}: {} is not a folder", scenario.references, folder.string()));
    files.references = io::load_station_scans(folder);
  }
  const TeleopSettings& teleop = scenario.teleop;
  if (!teleop.route.empty() && !teleop.recorded.empty()) {
    throw InputError("teleop: route and recorded are mutually exclusive: only one of them is allowed");
  }
  if (!teleop.route.empty()) files.teleop_route = io::load_teleop_route(named_file("teleop.route", teleop.route));
  if (!teleop.recorded.empty()) files.recorded = io::load_teleop(named_file("teleop.recorded", teleop.recorded));
  const bool has_operator_goal = std::any_of(files.goals.begin(), files.goals.end(),
                                             [](const SavedGoal& goal) { return goal.type == GoalType::kOperator; });
  if (files.map && files.has_teleop() && !has_operator_goal) {
    throw InputError(fmt::format(
        "map = {}: map and teleop are mutually exclusive, because a teleoperated run builds a new map: both are "
        "allowed only with a goal of type R",
        scenario.map));
  }
  return files;
}

/// Returns whether a robot has the parts that a sensor measures.
bool is_fitted_sensor(const std::string& sensor, const RobotDescription& robot) {
  bool is_fitted_to_robot = true;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if (sensor == SensorTraits<Message>::kInfo.name) is_fitted_to_robot = is_fitted<Message>(robot);
  });
  return is_fitted_to_robot;
}

/// Refuses faults that have no effect. Sensors without a frame of the robot are refused with the other needs of the
/// scenario (sensor_needs.h).
void check_faults(const std::vector<sim::FaultSettings>& faults, const std::string& robot_name,
                  const RobotDescription& robot) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const sim::FaultSettings& fault = faults[i];
    if (!is_fitted_sensor(fault.sensor, robot))
      throw InputError(fmt::format("faults.{}.sensor = {}: {} has no such sensor", i, fault.sensor, robot_name));
    if ((fault.kind == "delay" || fault.kind == "jitter") && fault.magnitude < 0.0)
      throw InputError(
          fmt::format("faults.{}.magnitude = {:g}: must be at least 0 for {}", i, fault.magnitude, fault.kind));
  }
}

/// Paths of the files that a scenario names; errors have no location.
std::vector<std::filesystem::path> files_of(const Scenario& scenario, const std::filesystem::path& data_root) {
  const std::filesystem::path world = world_folder(scenario.world, data_root);
  const std::pair<const char*, const std::string&> named[] = {{"mission", scenario.mission},
                                                              {"map", scenario.map},
                                                              {"goals", scenario.goals},
                                                              {"teleop.route", scenario.teleop.route},
                                                              {"teleop.recorded", scenario.teleop.recorded}};
  std::vector<std::filesystem::path> files;
  for (const auto& [key, name] : named) {
    if (!name.empty()) files.push_back(find_named_file(world, key, name));
  }
  if (!scenario.map.empty()) {
    const std::filesystem::path map_yaml = find_named_file(world, "map", scenario.map);
    files.push_back(io::map_image(map_yaml));
    if (const auto registration = registration_of(map_yaml)) files.push_back(*registration);
  }
  if (!scenario.references.empty()) {
    for (const std::filesystem::path& file : io::station_scan_files(world / scenario.references)) files.push_back(file);
  }
  if (needs_neighbor_model(scenario.stack.slam.method)) files.push_back(data_root / kNeighborModel);
  return files;
}

}  // namespace

LoadedSite load_site(const std::string& world, const std::filesystem::path& data_root) {
  if (world.empty()) throw InputError("world: missing: name a folder of worlds");
  std::filesystem::path world_xml = find_world(world, data_root);
  const sim::SiteSettings settings = site_settings_of(world_xml);
  return {.world_xml = std::move(world_xml), .settings = settings};
}

Scenario default_scenario(const std::string& robot, const std::filesystem::path& data_root) {
  const std::filesystem::path profile = robot_file(robot, ".yaml", data_root);
  Scenario scenario = scenario_of_profile(profile, robot_file(robot, ".urdf", data_root));
  if (const std::optional<RobotDescription> described = robot_of(robot, data_root, scenario.mounts)) {
    check_profile(profile, *described, scenario);
    disable_absent_sensors(*described, {}, scenario);
  }
  return scenario;
}

Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  refuse_world(file);
  return load_scenario(file, overrides, find_data_root(file));
}

Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                       const std::filesystem::path& data_root) {
  Scenario named;
  io::SettingsReader::read_section({file.string(), overrides}, load_with_presets(file, overrides), "", named);
  const std::string robot = named.robot;
  const std::filesystem::path profile = robot_file(robot, ".yaml", data_root);
  const Scenario of_profile = scenario_of_profile(profile, robot_file(robot, ".urdf", data_root));
  Scenario scenario = of_profile;
  read_over(file, overrides, scenario);
  scenario.file = file;
  scenario.overrides = overrides;
  scenario.robot_location = location_of(file, find_node(lines_of(file, "robot", overrides), {"robot"}), "robot");
  constexpr const char* kMissionType = "stack.mission_type";
  scenario.mission_type_location =
      location_of(file, find_node(lines_of(file, kMissionType, overrides), {"stack", "mission_type"}), kMissionType);
  if (const std::optional<RobotDescription> described = robot_of(robot, data_root, scenario.mounts)) {
    check_profile(profile, *described, of_profile);
    with_location(scenario, [&] { check_faults(scenario.faults, robot, *described); });
    const std::vector<std::string> enabled = enabled_by_name(io::load_document(file, overrides));
    disable_absent_sensors(*described, enabled, scenario);
    const bool is_asked_for_uwb = std::ranges::find(enabled, "uwb") != enabled.end();
    if (!is_asked_for_uwb && !has_uwb_anchors(scenario.world, data_root)) scenario.sensors.uwb.enabled = false;
  }
  return scenario;
}

std::string to_yaml(const Scenario& scenario) { return io::to_yaml(scenario); }

std::filesystem::path registration_beside(const std::filesystem::path& map_yaml) {
  return map_yaml.parent_path() / "registration.json";
}

void save_scenario(const std::filesystem::path& file, const Scenario& scenario, const std::string& comment) {
  io::save_settings(file, scenario, comment);
}

std::vector<std::filesystem::path> named_files(const Scenario& scenario, const std::filesystem::path& data_root) {
  return with_location(scenario, [&] { return files_of(scenario, data_root); });
}

Route load_route(const Scenario& scenario, const std::filesystem::path& data_root) {
  return load_mission_alone(scenario, data_root).route;
}

Pose2 load_start(const Scenario& scenario, const std::filesystem::path& data_root) {
  return load_mission_alone(scenario, data_root).T_site_start;
}

ScenarioFiles load_scenario_files(const Scenario& scenario, const std::filesystem::path& data_root) {
  return with_location(scenario, [&] { return load_files(scenario, data_root); });
}

}  // namespace patrol::app
