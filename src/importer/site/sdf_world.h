#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sdf/sdf.hh>

#include "core/frames.h"
#include "importer/assumptions.h"
#include "importer/site/sdf_files.h"
#include "importer/site/sdf_models.h"
#include "importer/site/site_import.h"

namespace patrol::importer {

/// SDF world as libsdformat reads it, with its models included.
class SdfWorld {
 public:
  /// Reads a file with its models (SdfModels, SdfFiles). The options must outlive the object. Throws InputError with
  /// one line, "file:line: what", for the first error of these or of libsdformat, with the place in the world or in the
  /// included model.
  explicit SdfWorld(const SiteImportOptions& options);
  SdfWorld(const SdfWorld&) = delete;
  SdfWorld& operator=(const SdfWorld&) = delete;

  const sdf::World& world() const { return *root_.WorldByIndex(0); }
  const std::vector<Assumption>& rows() const { return files_.rows(); }

  /// Returns the path of a mesh or a picture. `uri` as for Packages, or relative to the file that has the element.
  /// Throws InputError with file and line if the file does not exist.
  std::filesystem::path resolve(const std::string& uri, const sdf::ElementPtr& element) const;

  /// Returns a path relative to the folder of the world.
  std::string relative(const std::filesystem::path& path) const { return models_.packages().relative(path); }

  const std::vector<SdfFiles::File>& files() const { return files_.files(); }

  /// Returns where a line of a file is, "line 12" in the world; in another file, "model.sdf:12" with its folder.
  std::string short_location_of(const SdfFiles::File& file, std::optional<int> line) const;

  /// Returns where an element of the world is, as above. An element without a line, because libsdformat does not know
  /// it, is where its name first occurs.
  std::string short_location_of(const sdf::ElementPtr& element) const;

  /// Throws InputError "file:line: <element>: what".
  [[noreturn]] void fail(const sdf::ElementPtr& element, const std::string& what) const;

 private:
  [[noreturn]] void fail(const sdf::Errors& errors, const sdf::ParserConfig& config) const;
  [[noreturn]] void fail(const SdfFiles::File& file, const sdf::Error& error, const sdf::ParserConfig& config) const;
  std::string place_of(const std::filesystem::path& path, std::optional<int> line) const;

  SdfModels models_;
  SdfFiles files_;
  sdf::Root root_;
};

Pose3 to_pose(const ignition::math::Pose3d& pose);

/// Returns the names of the element and of what it belongs to, "world default / model box / link body".
std::string path_of(const sdf::ElementPtr& element);

}  // namespace patrol::importer
