#include "app/scenario/run_hash.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include "app/scenario/data_folders.h"
#include "core/error.h"
#include "io/files/digest.h"
#include "io/yaml/settings_yaml.h"
#include "link/socket.h"
#include "link/stack_process.h"

namespace patrol::app {
namespace {

/// Files that the words of a stack's command name, in the order of the words: the program, found by PATH, and those of
/// its arguments that are existing regular files. Empty for an address and for an invalid command, which the run
/// reports.
std::vector<std::filesystem::path> files_of_command(const std::string& command) {
  std::vector<std::filesystem::path> files;
  if (command.empty() || link::is_address(command)) return files;
  try {
    const std::vector<std::string> words = link::command_words(command);
    if (const auto program = link::find_program(words.front())) files.push_back(*program);
    for (std::size_t i = 1; i < words.size(); ++i) {
      std::error_code ignored;
      if (std::filesystem::is_regular_file(words[i], ignored)) files.emplace_back(words[i]);
    }
  } catch (const InputError&) {
    files.clear();
  }
  return files;
}

}  // namespace

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
                                  folder_digest(find_world(scenario.world, data_root_).parent_path(), "scenarios"),
                                  folder_digest(find_robot(scenario.robot, data_root_).parent_path(), ""));
  for (const std::filesystem::path& file : named_files(scenario, data_root_))
    asked += fmt::format("file {}\n", file_digest(file));
  for (const std::filesystem::path& file : files_of_command(scenario.stack.command))
    asked += fmt::format("stack {}\n", file_digest(file));
  asked += to_yaml(scenario);
  return io::sha256(asked).substr(0, kDigits);
}

}  // namespace patrol::app
