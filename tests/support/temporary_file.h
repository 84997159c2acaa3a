#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace patrol::test {

/// A file that holds `text` and goes when this object goes.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : directory_(std::filesystem::temp_directory_path() /
                   ("patrol_" + std::to_string(getpid()) + "_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)))),
        path_((directory_ / name).string()) {
    std::filesystem::create_directories(directory_);
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove_all(directory_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::filesystem::path directory_;
  std::string path_;
};

}  // namespace patrol::test
