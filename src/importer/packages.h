#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace patrol::importer {

/// Folders of packages, by name: given ones, and those found near a file.
class Packages {
 public:
  Packages(std::map<std::string, std::filesystem::path> given, const std::filesystem::path& file);

  /// Returns the folder of a package: the given one; else, in the folders above the file, one with this name, or one
  /// whose package.xml has this name.
  std::optional<std::filesystem::path> find(const std::string& package) const;

  /// Returns the path of a mesh: `package://PKG/path`, `model://PKG/path`, `file://path`, or a path relative to the
  /// file. Throws InputError without file and line if the package is unknown.
  std::filesystem::path resolve(const std::string& uri) const;

 private:
  std::map<std::string, std::filesystem::path> given_;
  std::filesystem::path folder_;  ///< of the file
};

}  // namespace patrol::importer
