#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace patrol::app {

/// Folder that only the user can access, and that is removed on destruction.
class TemporaryFolder {
 public:
  /// `purpose` is part of its name. Throws std::runtime_error if it cannot be created.
  explicit TemporaryFolder(const std::string& purpose) {
    std::string name = (std::filesystem::temp_directory_path() / fmt::format("patrol-{}-XXXXXX", purpose)).string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error(name + ": cannot be created");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace patrol::app
