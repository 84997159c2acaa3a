#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/stack/stack_settings.h"
#include "core/remote_drive.h"
#include "core/route.h"
#include "core/settings.h"
#include "io/expectations.h"
#include "io/station_scans.h"
#include "render/light.h"
#include "sim/twin.h"

namespace patrol::app {

/// How far off the surveyed start the robot is really put down: an operator's carelessness. The stack does not know.
struct StartOffsetSettings {
  double ahead_m = 0.0;
  double left_m = 0.0;
  double turn_deg = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ahead_m", self.ahead_m);
    visit("left_m", self.left_m);
    visit("turn_deg", self.turn_deg, between(-180.0, 180.0));
  }
};

/// Who drives while the map is made, and the goals are marked. At most one of the two.
struct RemoteSettings {
  std::string drive;     ///< where a person at the remote control drives, below the world's folder
  std::string recorded;  ///< or a table of commands that were recorded, likewise
  sim::RemoteOperatorSettings driver;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("drive", self.drive);
    visit("recorded", self.recorded);
    visit("driver", self.driver);
  }
};

/// The robot is lifted to another place, and nobody tells it.
struct KidnapSettings {
  double at_s = 0.0;
  double x_m = 0.0;  ///< in world
  double y_m = 0.0;
  double heading_deg = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("at_s", self.at_s, at_least(0.0));
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("heading_deg", self.heading_deg, between(-360.0, 360.0));
  }
};

/// What is written besides the messages.
struct LogSettings {
  double truth_rate_hz = 100.0;
  double state_rate_hz = 50.0;  ///< for the replay
  double map_period_s = 5.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("truth_rate_hz", self.truth_rate_hz, between(1.0, 500.0));
    visit("state_rate_hz", self.state_rate_hz, between(1.0, 500.0));
    visit("map_period_s", self.map_period_s, at_least(0.1));
  }
};

/// One run: a YAML file says what is special, the defaults stand here and in the settings that this struct gathers.
struct Scenario {
  int version = 1;
  std::string world = "street";
  std::string robot = "quadruped";
  std::uint64_t seed = 1;
  double time_limit_s = 900.0;  ///< simulated
  std::string mission = "routes/boxes_and_well.json";  ///< below the world's folder
  std::string map;    ///< map_server YAML below the world's folder, in map; empty: the robot makes its own
  std::string goals;  ///< nav.json likewise; empty: marked on the drive by remote control
  std::string references;  ///< a folder likewise, with the scans of an earlier round (io/station_scans.h)
  RemoteSettings remote;
  StartOffsetSettings start;
  sim::SensorSuiteSettings sensors;
  sim::LocomotionSettings locomotion;      ///< of a robot with legs
  sim::TrackDriveSettings track_drive;     ///< of a robot with tracks
  StackSettings stack;
  std::vector<sim::PropSettings> props;
  sim::LowObstacleSettings low_obstacles;  ///< scattered by the seed, beside the props
  std::vector<sim::LiningMoveSettings> lining;  ///< how its rings have moved
  std::vector<sim::ActorSettings> actors;
  std::vector<sim::LeakSettings> leaks;
  sim::WindSettings wind;
  sim::RockSettings rock;
  std::vector<sim::WaterBodySettings> water;  ///< ahead of the face
  render::LightSettings light;  ///< of the replay; for dust see sensors.dust
  std::vector<sim::FaultSettings> faults;
  std::vector<KidnapSettings> kidnaps;
  LogSettings log;
  io::Expectations expect;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("version", self.version, between(1, 1));
    visit("world", self.world);
    visit("robot", self.robot);
    visit("seed", self.seed);
    visit("time_limit_s", self.time_limit_s, between(0.1, 86400.0));
    visit("mission", self.mission);
    visit("map", self.map);
    visit("goals", self.goals);
    visit("references", self.references);
    visit("remote", self.remote);
    visit("start", self.start);
    visit("sensors", self.sensors);
    visit("locomotion", self.locomotion);
    visit("track_drive", self.track_drive);
    visit("stack", self.stack);
    visit("props", self.props);
    visit("low_obstacles", self.low_obstacles);
    visit("lining", self.lining);
    visit("actors", self.actors);
    visit("leaks", self.leaks);
    visit("wind", self.wind);
    visit("rock", self.rock);
    visit("water", self.water);
    visit("light", self.light);
    visit("faults", self.faults);
    visit("kidnaps", self.kidnaps);
    visit("log", self.log);
    visit("expect", self.expect);
  }
};

/// What a robot's own file, models/<robot>/<robot>.yaml, may say: where it differs from the defaults.
struct RobotProfile {
  sim::SensorSuiteSettings sensors;
  sim::LocomotionSettings locomotion;
  sim::TrackDriveSettings track_drive;
  StackSettings stack;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sensors", self.sensors);
    visit("locomotion", self.locomotion);
    visit("track_drive", self.track_drive);
    visit("stack", self.stack);
  }
};

/// What a scenario of this robot says where it says nothing: the defaults, under the robot's own file if it has one.
Scenario default_scenario(const std::string& robot, const std::filesystem::path& data_root);

/// A scenario file with "path=value" overrides, over its robot's profile, over the defaults. Throws InputError with file,
/// line and key.
Scenario load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Every setting written out, under a line of comment.
void save_scenario(const std::filesystem::path& file, const Scenario& scenario, const std::string& comment);

/// Folder that holds `worlds/` and `models/`: the environment variable PATROL_DATA; else the nearest such folder above `scenario`; else the
/// working directory; else ../share/patrol or .. seen from the program's folder; else the source tree that the program was built from.
/// Throws InputError when there is none, or PATROL_DATA names another folder.
std::filesystem::path find_data_root(const std::filesystem::path& scenario);

/// Where the files lie that a scenario names: mission, map and its image, goals, remote control. Throws InputError, naming file and key,
/// when one is missing.
std::vector<std::filesystem::path> named_files(const Scenario& scenario, const std::filesystem::path& data_root);

/// The files that a scenario names, found and read.
struct ScenarioFiles {
  std::filesystem::path world_xml;
  std::filesystem::path robot_urdf;
  RobotDescription robot;
  Route route;          ///< in site
  Pose2 T_site_start;   ///< surveyed
  RemoteDrive drive;                    ///< in site
  std::vector<RemoteCommand> recorded;
  std::vector<MarkedGoal> goals;        ///< in map
  std::vector<io::StationScan> references;
  std::optional<OccupancyGrid> map;

  bool has_remote() const { return !drive.empty() || !recorded.empty(); }
};

/// Throws InputError, naming file and key, when one is missing or wrong.
ScenarioFiles load_scenario_files(const Scenario& scenario, const std::filesystem::path& data_root);

}  // namespace patrol::app
