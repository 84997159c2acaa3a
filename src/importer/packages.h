#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"

namespace patrol::importer {

/// Error of a mesh that is not where the description names it, nor near it.
struct MeshNotFound : InputError {
  using InputError::InputError;
};

/// Folders of packages, by name: given ones, and those found near a file.
class Packages {
 public:
  /// Throws InputError if a given folder is none.
  Packages(std::map<std::string, std::filesystem::path> given, const std::filesystem::path& file);

  /// Returns the folder of a package: the given one; else, in the folders above the file, one with this name, or one
  /// whose package.xml has this name.
  std::optional<std::filesystem::path> find(const std::string& package) const;

  /// Returns the path of a mesh: `package://PKG/path`, `model://PKG/path`, `file://path`, or a path relative to the
  /// file. Throws InputError without file and line if the package is unknown.
  std::filesystem::path resolve(const std::string& uri) const;

  /// Returns the path of an existing mesh: the one of `resolve`; else the same path, or the end of an absolute one,
  /// from one of the three folders above the file; else the only file of this name in the file's package (or folder,
  /// if it is in no package). Throws InputError without file and line if there is none.
  std::filesystem::path find_mesh(const std::string& uri) const;

  /// Returns the path of a URI behind its scheme, package, root and leading "..", then without its first folders, down
  /// to two parts.
  static std::vector<std::filesystem::path> ends_of(const std::string& uri);

  /// Returns a folder and the three above it.
  static std::vector<std::filesystem::path> with_folders_above(std::filesystem::path folder);

  /// Returns the folder that is given for a package.
  std::optional<std::filesystem::path> given(const std::string& package) const;

  /// Returns a path relative to the folder of the file, for messages.
  std::string relative(const std::filesystem::path& path) const;

 private:
  std::optional<std::filesystem::path> with_name(const std::string& name) const;

  std::map<std::string, std::filesystem::path> given_;  ///< given folders, by name of the package
  std::filesystem::path folder_;                        ///< folder of the file
};

}  // namespace patrol::importer
