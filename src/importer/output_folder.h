#pragma once

#include <filesystem>
#include <string>

namespace patrol::importer {

/// Extension of a staging folder. One remains if the program is killed.
inline constexpr const char* kStagingExtension = ".part";

/// Folder that is written beside its final place and renamed when it is complete. It is removed with its content
/// otherwise.
class OutputFolder {
 public:
  /// Creates the staging folder. Throws InputError if the target exists and is not an empty folder, or if nothing can
  /// be written beside it.
  explicit OutputFolder(const std::filesystem::path& target);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Folder to write to until `publish`.
  const std::filesystem::path& staging() const { return staging_; }

  /// Renames the staging folder to the target. Throws InputError if that fails.
  void publish();

 private:
  std::filesystem::path target_, staging_;
};

/// Throws InputError with the file unless the name can be that of a folder. `subject` is "robot" or "site".
void require_folder_name(const std::string& name, const std::string& file, const char* subject);

}  // namespace patrol::importer
