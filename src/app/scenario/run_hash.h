#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/scenario/scenario.h"

namespace patrol::app {

/// SHA-256 of the program's executable file.
std::string build_id();

/// Computes the content hash of a run from everything that determines its result. Inputs are the resolved scenario, the
/// files of its world, its robot and those that it names, the program and its MuJoCo. With `stack.command` also the
/// content of the files that its words name: the program and arguments such as a script. Files that these read by
/// themselves are not included. Runs of equal hash give equal bytes; a new build changes all hashes.
class RunHasher {
 public:
  explicit RunHasher(std::filesystem::path data_root);

  /// Content hash of a run, 20 hexadecimal digits of a SHA-256.
  std::string hash(const Scenario& scenario);

 private:
  const std::string& folder_digest(const std::filesystem::path& folder, const std::string& except);
  const std::string& file_digest(const std::filesystem::path& file);

  std::filesystem::path data_root_;
  std::string program_;
  std::map<std::filesystem::path, std::string> digests_;  ///< digests of folders and files read before
};

}  // namespace patrol::app
