#include "app/scenario/data_folders.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace patrol::app {
namespace {

bool contains_data(const std::filesystem::path& root) {
  std::error_code ignored;
  return std::filesystem::is_directory(root / "worlds", ignored) &&
         std::filesystem::is_directory(root / "models", ignored);
}

/// Data folder of the program's own installation (bin/patrol and share/patrol) or of the source tree of its build
/// folder; empty if there is none.
std::filesystem::path data_root_of_program() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path outer = program.parent_path().parent_path();
  for (const std::filesystem::path& root : {outer / "share/patrol", outer}) {
    if (contains_data(root)) return root;
  }
  return {};
}

/// Folders in which robots and worlds are searched, in order; some may be equal or empty.
std::array<std::filesystem::path, 3> searched_roots(const std::filesystem::path& root) {
  return {root, std::filesystem::current_path(), data_root_of_program()};
}

/// Names of the robots or worlds in all searched folders, sorted, for "known: ..." in messages.
std::string known_names(const std::filesystem::path& root, const std::string& kind, const std::string& extension) {
  std::set<std::string> names;
  for (const std::filesystem::path& data : searched_roots(root)) {
    std::error_code none;
    if (data.empty()) continue;
    for (const auto& entry : std::filesystem::directory_iterator(data / kind, none)) {
      const std::string name = entry.path().filename().string();
      if (std::filesystem::exists(entry.path() / (name + extension), none)) names.insert(name);
    }
  }
  return join(std::vector<std::string>(names.begin(), names.end()), ", ");
}

/// Path <root>/<kind>/<name>/<name><extension>. Throws InputError if it does not exist.
std::filesystem::path find_definition(const std::filesystem::path& root, const std::string& kind,
                                      const std::string& key, const std::string& name, const std::string& extension) {
  std::filesystem::path file = root / kind / name / (name + extension);
  if (!std::filesystem::exists(file)) {
    throw InputError(
        fmt::format("{} = {}: {} not found (known: {})", key, name, file.string(), known_names(root, kind, extension)));
  }
  return file;
}

/// Folder of a robot or a world: the first that has its definition, below the data root, the working directory or the
/// data of the program; below the data root if none has.
std::filesystem::path folder_of(const std::filesystem::path& root, const std::string& kind, const std::string& name,
                                const std::string& extension) {
  for (const std::filesystem::path& data : searched_roots(root)) {
    if (!data.empty() && std::filesystem::exists(data / kind / name / (name + extension))) return data / kind / name;
  }
  return root / kind / name;
}

}  // namespace

std::filesystem::path find_data_root(const std::filesystem::path& scenario) {
  if (const char* named = std::getenv("PATROL_DATA"); named != nullptr && *named != '\0') {
    if (!contains_data(named)) {
      throw InputError(
          fmt::format("PATROL_DATA = {}: must be a folder that contains the folders worlds and models", named));
    }
    return std::filesystem::absolute(named);
  }
  std::filesystem::path folder =
      scenario.empty() ? std::filesystem::current_path() : std::filesystem::absolute(scenario).parent_path();
  for (; folder != folder.parent_path(); folder = folder.parent_path()) {
    if (contains_data(folder)) return folder;
  }
  if (contains_data(std::filesystem::current_path())) return std::filesystem::current_path();
  if (std::filesystem::path found = data_root_of_program(); !found.empty()) return found;
  if (contains_data(PATROL_SOURCE_DIR)) return PATROL_SOURCE_DIR;
  throw InputError(
      "folders worlds and models not found near the scenario or the program: set PATROL_DATA to the folder that "
      "contains them");
}

std::vector<DataFolder> data_folders() {
  const std::filesystem::path here = std::filesystem::current_path(), of_program = data_root_of_program();
  const auto is_same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    return !b.empty() && std::filesystem::equivalent(a, b, ignored);
  };
  std::vector<DataFolder> folders;
  for (const std::filesystem::path& path : {find_data_root({}), here, of_program}) {
    const bool is_known =
        std::ranges::any_of(folders, [&](const DataFolder& known) { return is_same(known.path, path); });
    if (path.empty() || is_known) continue;
    folders.push_back({path, is_same(path, of_program) || is_same(path, PATROL_SOURCE_DIR) ? "program"
                             : is_same(path, here)                                         ? "working directory"
                                                                                           : path.string()});
  }
  return folders;
}

std::filesystem::path robot_file(const std::string& robot, const std::string& extension,
                                 const std::filesystem::path& data_root) {
  return folder_of(data_root, "models", robot, ".urdf") / (robot + extension);
}

std::filesystem::path world_folder(const std::string& world, const std::filesystem::path& data_root) {
  return folder_of(data_root, "worlds", world, ".xml");
}

std::filesystem::path find_robot(const std::string& name, const std::filesystem::path& data_root) {
  std::filesystem::path urdf = robot_file(name, ".urdf", data_root);
  return std::filesystem::exists(urdf) ? urdf : find_definition(data_root, "models", "robot", name, ".urdf");
}

std::filesystem::path find_world(const std::string& name, const std::filesystem::path& data_root) {
  std::filesystem::path xml = world_folder(name, data_root) / (name + ".xml");
  return std::filesystem::exists(xml) ? xml : find_definition(data_root, "worlds", "world", name, ".xml");
}

std::optional<std::string> world_of(const std::filesystem::path& name) {
  if (name.extension() == ".yaml" || name.extension() == ".yml") return std::nullopt;
  const std::filesystem::path folder = name.has_filename() ? name : name.parent_path();  // worlds/street/
  const std::string world = folder.filename().string();
  if (folder.has_parent_path()) {
    if (!std::filesystem::exists(folder / (world + ".xml"))) return std::nullopt;
    const std::filesystem::path found = world_folder(world, find_data_root({}));
    std::error_code ignored;
    return std::filesystem::equivalent(folder, found, ignored) ? std::optional(world) : std::nullopt;
  }
  const bool is_world = std::filesystem::exists(world_folder(world, find_data_root({})) / (world + ".xml"));
  return is_world ? std::optional(world) : std::nullopt;
}

void refuse_world(const std::filesystem::path& name) {
  if (name.empty() || std::filesystem::is_regular_file(name)) return;
  const std::optional<std::string> world = world_of(name);
  if (!world) return;
  std::vector<std::string> scenarios;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(world_folder(*world, find_data_root({})) / "scenarios", none)) {
    if (entry.path().extension() == ".yaml") scenarios.push_back(*world + "/" + entry.path().stem().string());
  }
  std::ranges::sort(scenarios);
  throw InputError(
      fmt::format("{}: is a world: must be a scenario ({}) or, for patrol run, a world with --start and --goal",
                  name.string(), scenarios.empty() ? "the world has none" : join(scenarios, ", ")));
}

std::filesystem::path find_scenario(const std::filesystem::path& name) {
  if (std::filesystem::exists(name) || name.has_extension() || name.is_absolute() || !name.has_parent_path())
    return name;
  try {
    const std::filesystem::path file = world_folder(name.parent_path().string(), find_data_root(name)) / "scenarios" /
                                       (name.filename().string() + ".yaml");
    return std::filesystem::exists(file) ? file : name;
  } catch (const InputError&) {
    return name;  // without data, the error is that the file does not exist
  }
}

}  // namespace patrol::app
