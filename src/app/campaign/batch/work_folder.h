#pragma once

#include <filesystem>
#include <string>

namespace patrol::app {

/// Folder of the active runs, `root/work/HOST-PID-KEY`. Several processes on several hosts may work below one root.
/// The constructor removes what dead processes of this host left, the destructor what this process left.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& root);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::filesystem::path path(const std::string& key) const { return folder_ / (prefix_ + key); }

 private:
  std::filesystem::path folder_;
  std::string prefix_;
};

}  // namespace patrol::app
