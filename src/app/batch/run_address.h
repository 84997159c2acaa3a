#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "app/scenario.h"

namespace patrol::app {

/// SHA-256 of this program's file.
std::string build_id();

/// Names a run's result by everything that it depends on: the resolved scenario, the files of its world, its robot and those that
/// it names, this program and its MuJoCo. Two runs of one address give the same bytes; a new build asks for new addresses.
class RunAddresses {
 public:
  explicit RunAddresses(std::filesystem::path data_root);

  /// 20 hexadecimal digits of a SHA-256.
  std::string of(const Scenario& scenario);

 private:
  const std::string& digest_of(const std::filesystem::path& folder, const std::string& except);
  const std::string& digest_of_file(const std::filesystem::path& file);

  std::filesystem::path data_root_;
  std::string program_;
  std::map<std::filesystem::path, std::string> digests_;  ///< of folders and files that were read before
};

}  // namespace patrol::app
