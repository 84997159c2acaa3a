#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/robot_description.h"

namespace patrol::app {

/// Completes the mounts of a file: sets their locations and checks frames and presets. `document` is the file; without
/// its list of mounts, locations have no line. Throws InputError with file, line and key.
void complete_mounts(const std::filesystem::path& file, const YAML::Node& document, std::vector<MountSettings>& mounts);

/// Returns the names of the sensors that a mount switches on.
std::vector<std::string> sensors_of(const MountSettings& mount);

/// Switches the sensor of a mount on and applies its preset.
void mount_sensor(const MountSettings& mount, sim::SensorSuiteSettings& sensors);

/// Returns the mounts of a robot with those of a scenario, which replace mounts of the same frame.
std::vector<MountSettings> merge_mounts(std::vector<MountSettings> of_robot, const std::vector<MountSettings>& own);

/// Robot of `models` with its mounts.
struct LoadedRobot {
  std::filesystem::path urdf_file;
  std::string urdf;  ///< content of the URDF with the mounts
  RobotDescription description;
};

/// Loads a robot of `models` (`find_robot`) with mounts. Throws InputError with the known robots if there is none, and
/// with the location of a mount that does not fit.
LoadedRobot load_robot(const std::string& name, const std::filesystem::path& data_root,
                       const std::vector<MountSettings>& mounts);

/// Returns the node of a path below a node; undefined if there is none.
YAML::Node find_node(const YAML::Node& document, const std::vector<std::string>& path);

/// Returns "file:line: key", the location of a node in messages; the key without a file.
std::string location_of(const std::filesystem::path& file, const YAML::Node& node, const std::string& key);

/// Returns a message that begins with a key of a scenario, "leaks.0.at = x: ...", with the place of the key before it:
/// "file:line: " or "--set path=value: ". Other messages, and those of keys that neither has, are unchanged.
std::string with_location_of_key(const Scenario& scenario, const std::string& message);

/// Calls a function; an InputError that it throws gets the place of the key with which its message begins.
template <typename Function>
auto with_location(const Scenario& scenario, Function&& function) {
  try {
    return function();
  } catch (const InputError& error) {
    throw InputError(with_location_of_key(scenario, error.what()));
  }
}

}  // namespace patrol::app
