#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Search for robots, worlds and scenarios in the data of the program and in the working directory.
namespace patrol::app {

/// Finds the folder that contains `worlds/` and `models/`. Candidates in order: the environment variable PATROL_DATA;
/// the nearest such folder above `scenario`; the working directory; ../share/patrol or .. relative to the program's
/// folder; the source tree of the build. Throws InputError if there is none, or if PATROL_DATA names another folder.
std::filesystem::path find_data_root(const std::filesystem::path& scenario);

/// Folder with `worlds/` or `models/`.
struct DataFolder {
  std::filesystem::path path;
  std::string name;  ///< "program", "working directory", or the path of another folder
};

/// Folders in which robots and worlds are searched, in order: the data root without a scenario, the working directory
/// and the data of the program, each once. A name that is in several folders is that of the first. Throws InputError as
/// `find_data_root`.
std::vector<DataFolder> data_folders();

/// Path of a file of a robot, models/ROBOT/ROBOT<extension>: below the data root, the working directory or the data of
/// the program, the first that has the robot's URDF. The file need not exist.
std::filesystem::path robot_file(const std::string& robot, const std::string& extension,
                                 const std::filesystem::path& data_root);

/// Folder of a world, worlds/WORLD: below the data root, the working directory or the data of the program, the first
/// that has the world's MJCF. It need not exist.
std::filesystem::path world_folder(const std::string& world, const std::filesystem::path& data_root);

/// Returns the URDF file of a robot of `models`. Throws InputError with the known robots if there is none.
std::filesystem::path find_robot(const std::string& name, const std::filesystem::path& data_root);

/// Returns the MJCF file of a world. Throws InputError with the known worlds if there is none.
std::filesystem::path find_world(const std::string& name, const std::filesystem::path& data_root);

/// Returns the world that a name (street) or a folder (worlds/street) refers to; nullopt if it is neither.
std::optional<std::string> world_of(const std::filesystem::path& name);

/// Throws InputError with the scenarios of the world if `name` refers to a world instead of a scenario.
void refuse_world(const std::filesystem::path& name);

/// Returns the file of a scenario: `name` itself if it exists, else the scenario WORLD/NAME of the data root or the
/// working directory (for example street/patrol). Returns `name` if there is neither.
std::filesystem::path find_scenario(const std::filesystem::path& name);

}  // namespace patrol::app
