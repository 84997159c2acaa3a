#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/tour.h"
#include "core/boosted_stumps.h"
#include "core/route.h"
#include "core/settings.h"
#include "core/site/geodetic_datum.h"
#include "core/site/site_registration.h"
#include "core/teleop_route.h"
#include "io/points/station_scans.h"
#include "io/yaml/expectations.h"
#include "render/scene/light.h"
#include "sim/simulator/simulator.h"
#include "stack/settings/stack_settings.h"

namespace patrol::app {

/// Offset of the actual start from the surveyed start: placement error of the operator. It is not known to the stack.
struct StartOffsetSettings {
  double ahead_m = 0.0;  ///< displacement of the actual start ahead of the surveyed one
  double left_m = 0.0;   ///< displacement of the actual start to the left of the surveyed one
  double yaw_deg = 0.0;  ///< rotation of the actual start from the surveyed one, counterclockwise

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ahead_m", self.ahead_m);
    visit("left_m", self.left_m);
    visit("yaw_deg", self.yaw_deg, between(-180.0, 180.0));
  }
};

/// Source of teleoperation commands while the map is built and goals are saved. At most one of `route` and `recorded`.
struct TeleopSettings {
  std::string route;                            ///< route of the simulated operator, below the world's folder
  std::string recorded;                         ///< table of recorded commands, below the world's folder
  sim::TeleopOperatorSettings teleop_operator;  ///< simulated operator that drives along the route

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("route", self.route);
    visit("recorded", self.recorded);
    visit("operator", self.teleop_operator);
  }
};

/// Kidnapping of the robot: it is moved to another pose without notice to the stack.
struct KidnapSettings {
  double at_s = 0.0;         ///< time of the kidnapping
  double x_m = 0.0;          ///< x of the new position in the world
  double y_m = 0.0;          ///< y of the new position in the world
  double heading_deg = 0.0;  ///< heading at the new position in the world

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at_s", self.at_s, at_least(0.0));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("heading_deg", self.heading_deg, between(-360.0, 360.0));
  }
};

/// Mount of a sensor: adds a frame to the robot, or moves a frame of its URDF together with the shapes of its link. An
/// added frame has neither mass nor shape. A mount switches its sensor on unless the settings of the sensor say
/// otherwise.
struct MountSettings {
  std::string frame;                 ///< name of the sensor frame, e.g. "tdlas"
  std::string parent = "base_link";  ///< link that is fixed to `base_link`, or `base_link`
  double x_m = 0.0;                  ///< x of the sensor frame in the parent
  double y_m = 0.0;                  ///< y of the sensor frame in the parent
  double z_m = 0.0;                  ///< z of the sensor frame in the parent
  double roll_deg = 0.0;             ///< roll of the sensor frame in the parent
  double pitch_deg = 0.0;            ///< pitch of the sensor frame in the parent
  double yaw_deg = 0.0;              ///< yaw of the sensor frame in the parent
  std::string preset;                ///< model of a lidar (sensors.lidar.preset); empty: that of the settings
  std::string location;              ///< file, line and key for messages; not a setting

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("frame", self.frame);
    visit("parent", self.parent);
    visit("x_m", self.x_m, between(-2.0, 2.0));
    visit("y_m", self.y_m, between(-2.0, 2.0));
    visit("z_m", self.z_m, between(-2.0, 2.0));
    visit("roll_deg", self.roll_deg, between(-180.0, 180.0));
    visit("pitch_deg", self.pitch_deg, between(-90.0, 90.0));
    visit("yaw_deg", self.yaw_deg, between(-180.0, 180.0));
    visit("preset", self.preset);
  }
};

/// Reason for which a scenario needs a sensor.
struct SensorNeed {
  std::string sensor;  ///< name in the registry, "lidar"
  std::string by;      ///< settings key or part of the scenario that requires it, "stack.slam"
};

/// Scoring of an obstacle course: the run ends successfully at the last station, without a collision.
struct CourseSettings {
  double optimal_time_s = 0.0;  ///< time of the shortest path at the maximum speed; 0: not a course
  double arrival_m = 1.0;       ///< distance from the goal at which the time ends

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("optimal_time_s", self.optimal_time_s, at_least(0.0));
    visit("arrival_m", self.arrival_m, between(0.01, 100.0));
  }
};

/// Contents of the log besides the messages.
struct LogSettings {
  double truth_rate_hz = 100.0;  ///< rate of the ground truth in the log
  double state_rate_hz = 50.0;   ///< rate of simulator states for the replay
  double map_period_s = 5.0;     ///< time from one map in the log to the next

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("truth_rate_hz", self.truth_rate_hz, between(1.0, 500.0));
    visit("state_rate_hz", self.state_rate_hz, between(1.0, 500.0));
    visit("map_period_s", self.map_period_s, at_least(0.1));
  }
};

/// Scenario of one run. A YAML file sets what differs from the defaults, which are defined here and in the settings
/// that this struct contains.
struct Scenario {
  int version = 2;                  ///< version of the keys; 2 since they were renamed
  std::string world;                ///< name of the world, a folder of `worlds`
  std::string robot = "quadruped";  ///< name of the robot, a folder of `models`
  std::uint64_t seed = 1;           ///< seed of every random draw of the run
  double time_limit_s = 900.0;      ///< limit of the simulated time
  std::string mission;              ///< file of the mission's stations, below the world's folder; empty: the tour
  TourSettings tour;                ///< mission without a file; excludes `mission`
  std::string map;  ///< map of `map_server` (YAML) below the world's folder, in map; empty: the robot builds a map
  /// File of saved goals (nav.json) below the world's folder; empty: goals are saved during teleoperation.
  std::string goals;
  std::string references;  ///< folder below the world's folder with scans of an earlier run (io/points/station_scans.h)
  TeleopSettings teleop;
  StartOffsetSettings start;
  std::vector<MountSettings> mounts;  ///< sensors added to the robot or moved; they extend those of its file
  sim::AsBuiltSettings as_built = sim::AsBuiltSettings::as_delivered();  ///< tolerances of the simulated robot
  sim::SensorSuiteSettings sensors;
  sim::LocomotionSettings locomotion;   ///< locomotion of a legged robot
  sim::TrackDriveSettings track_drive;  ///< drive of a tracked robot
  sim::WheelDriveSettings wheel_drive;  ///< drive of a wheeled robot
  stack::StackSettings stack;
  std::vector<sim::StaticObstacleSettings> static_obstacles;
  sim::LowObstacleSettings low_obstacles;  ///< random obstacles by the seed, in addition to the static obstacles
  std::vector<sim::LiningDeformationSettings> lining_deformation;  ///< displacements of the lining's rings
  std::vector<sim::ActorSettings> actors;
  std::vector<sim::LeakSettings> leaks;
  sim::WindSettings wind;
  sim::RockSettings rock;
  std::vector<sim::WaterBodySettings> water_bodies;  ///< water bodies ahead of the tunnel face
  render::LightSettings light;                       ///< light of the replay; for dust see sensors.dust
  std::vector<sim::FaultSettings> faults;
  std::vector<KidnapSettings> kidnaps;
  CourseSettings course;
  LogSettings log;
  io::Expectations expect;             ///< bounds of metrics that the run must meet, by path of the metric
  std::filesystem::path file;          ///< file of the scenario, for messages; empty: none; not a setting
  std::vector<std::string> overrides;  ///< overrides "path=value", for messages; not a setting
  std::string robot_location;          ///< file, line and key of `robot` for messages; not a setting
  std::string mission_type_location;   ///< file, line and key of `stack.mission_type` for messages; not a setting
  std::vector<SensorNeed> requested;   ///< sensors that the file enables and the robot lacks; not a setting

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("version", self.version, between(1, 2));
    visit("world", self.world);
    visit("robot", self.robot);
    visit("seed", self.seed);
    visit("time_limit_s", self.time_limit_s, between(0.1, 86400.0));
    visit("mission", self.mission);
    visit("tour", self.tour);
    visit("map", self.map);
    visit("goals", self.goals);
    visit("references", self.references);
    visit("teleop", self.teleop);
    visit("start", self.start);
    visit("mounts", self.mounts);
    visit("as_built", self.as_built);
    visit("sensors", self.sensors);
    visit("locomotion", self.locomotion);
    visit("track_drive", self.track_drive);
    visit("wheel_drive", self.wheel_drive);
    visit("stack", self.stack);
    visit("static_obstacles", self.static_obstacles);
    visit("low_obstacles", self.low_obstacles);
    visit("lining_deformation", self.lining_deformation);
    visit("actors", self.actors);
    visit("leaks", self.leaks);
    visit("wind", self.wind);
    visit("rock", self.rock);
    visit("water_bodies", self.water_bodies);
    visit("light", self.light);
    visit("faults", self.faults);
    visit("kidnaps", self.kidnaps);
    visit("course", self.course);
    visit("log", self.log);
    visit("expect", self.expect);
  }
};

/// Robot profile, models/<robot>/<robot>.yaml: settings that differ from the defaults.
struct RobotProfile {
  std::vector<MountSettings> mounts;
  sim::AsBuiltSettings as_built = sim::AsBuiltSettings::as_delivered();
  sim::SensorSuiteSettings sensors;
  sim::LocomotionSettings locomotion;
  sim::TrackDriveSettings track_drive;
  sim::WheelDriveSettings wheel_drive;
  stack::StackSettings stack;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("mounts", self.mounts);
    visit("as_built", self.as_built);
    visit("sensors", self.sensors);
    visit("locomotion", self.locomotion);
    visit("track_drive", self.track_drive);
    visit("wheel_drive", self.wheel_drive);
    visit("stack", self.stack);
  }
};

/// MJCF and settings of a world.
struct LoadedSite {
  std::filesystem::path world_xml;
  sim::SiteSettings settings;  ///< those of WORLD.yaml beside the MJCF; the defaults without one
};

/// Finds a world and loads its settings. Throws InputError with the known worlds if there is none.
LoadedSite load_site(const std::string& world, const std::filesystem::path& data_root);

/// Default scenario of a robot: the robot's profile, if it has one, over the defaults. Sensors that only the defaults
/// enable are disabled if the robot has no frame for them.
Scenario default_scenario(const std::string& robot, const std::filesystem::path& data_root);

/// Loads a scenario file, or no file for an empty path, with "path=value" overrides, over its robot's profile, over the
/// defaults. Sensors that neither the file nor an override enables are disabled if the robot has no frame for them.
/// Throws InputError with file, line and key.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Loads a scenario with the robots and worlds of a data root instead of that of the file.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                       const std::filesystem::path& data_root);

/// Formats every setting as YAML.
std::string to_yaml(const Scenario& scenario);

/// Writes every setting, below a line of comment.
void save_scenario(const std::filesystem::path& file, const Scenario& scenario, const std::string& comment);

/// Paths of the files that a scenario names: mission, map and its image, goals, teleoperation. Throws InputError with
/// file and key if one is missing.
std::vector<std::filesystem::path> named_files(const Scenario& scenario, const std::filesystem::path& data_root);

/// Loads the stations of a scenario's mission, in site. Throws InputError as `load_scenario_files`.
Route load_route(const Scenario& scenario, const std::filesystem::path& data_root);

/// Loads the surveyed start of a scenario's mission, in site, and checks nothing else: the robot may lack sensors that
/// the mission needs. Throws InputError as `load_scenario_files`.
Pose2 load_start(const Scenario& scenario, const std::filesystem::path& data_root);

/// Path of the registration of a map to the site, which need not exist.
std::filesystem::path registration_beside(const std::filesystem::path& map_yaml);

/// Files that a scenario names, loaded.
struct ScenarioFiles {
  std::filesystem::path world_xml;
  sim::SiteSettings site;  ///< settings of the world, WORLD.yaml beside its MJCF; the defaults without one
  std::filesystem::path robot_urdf;
  std::string robot_urdf_text;  ///< content of the URDF with the mounts
  RobotDescription robot;
  std::string mission_text;             ///< content of the mission file, or that of a tour
  Route route;                          ///< in site
  Pose2 T_site_start;                   ///< surveyed start
  std::optional<GeodeticDatum> datum;   ///< WGS 84 position of the origin of site
  TeleopRoute teleop_route;             ///< in site
  std::vector<TeleopCommand> recorded;  ///< recorded teleoperation commands
  std::vector<SavedGoal> goals;         ///< in map
  std::vector<io::StationScan> references;
  std::optional<OccupancyGrid> map;
  std::optional<SiteRegistration> map_registration;  ///< saved beside the map
  BoostedStumps neighbor_model;  ///< classifier of pairs of submaps; empty for SLAM methods that need none

  /// Pose in site of the frame of the given map: its registration; without one, the surveyed start.
  Pose2 T_site_map() const { return map_registration ? map_registration->T_site_map : T_site_start; }
  /// Robot of the simulator: the URDF with the mounts.
  sim::RobotUrdf simulated_robot() const { return {robot_urdf.string(), robot_urdf_text}; }
  bool has_teleop() const { return !teleop_route.empty() || !recorded.empty(); }
};

/// Loads the files of a scenario. Throws InputError with file and key if one is missing or invalid, and if the robot
/// lacks a sensor that the scenario needs (sensor_needs.h).
ScenarioFiles load_scenario_files(const Scenario& scenario, const std::filesystem::path& data_root);

}  // namespace patrol::app
