#pragma once

#include <filesystem>
#include <string>

namespace patrol::app {

/// Folder of the active runs, `root/work/HOST-PID-ADDRESS`. Several processes on several hosts may work below one root.
/// The constructor removes what dead processes of this host left, the destructor what this process left.
class WorkFolder {
 public:
  explicit WorkFolder(const std::filesystem::path& root);
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  std::filesystem::path of(const std::string& address) const { return folder_ / (prefix_ + address); }

 private:
  std::filesystem::path folder_;
  std::string prefix_;
};

}  // namespace patrol::app
