#include "app/scenario/run_hash.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/scenario/data_folders.h"
#include "io/files/digest.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {

std::string build_id() { return io::sha256_of_file("/proc/self/exe"); }

RunHasher::RunHasher(std::filesystem::path data_root)
    : data_root_(std::move(data_root)), program_(fmt::format("patrol {} mujoco {}", build_id(), mj_versionString())) {}

const std::string& RunHasher::folder_digest(const std::filesystem::path& folder, const std::string& except) {
  const auto known = digests_.find(folder);
  if (known != digests_.end()) return known->second;
  return digests_[folder] = io::sha256_of_folder(folder, except);
}

const std::string& RunHasher::file_digest(const std::filesystem::path& file) {
  const auto known = digests_.find(file);
  if (known != digests_.end()) return known->second;
  return digests_[file] = io::sha256_of_file(file);
}

std::string RunHasher::hash(const Scenario& scenario) {
  constexpr std::size_t kDigits = 20;
  std::string asked = fmt::format("{}\nworld {}\nrobot {}\n", program_,
                                  folder_digest(world_folder(scenario.world, data_root_), "scenarios"),
                                  folder_digest(robot_file(scenario.robot, ".urdf", data_root_).parent_path(), ""));
  for (const std::filesystem::path& file : named_files(scenario, data_root_))
    asked += fmt::format("file {}\n", file_digest(file));
  asked += to_yaml(scenario);
  return io::sha256(asked).substr(0, kDigits);
}

}  // namespace patrol::app
