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
#include "importer/packages.h"
#include "importer/site/sdf_source.h"

namespace patrol::importer {

/// Temporary folder of the models that libsdformat is given without a folder of the user; removed at the end.
class BuiltInModels {
 public:
  BuiltInModels() = default;
  ~BuiltInModels();
  BuiltInModels(const BuiltInModels&) = delete;
  BuiltInModels& operator=(const BuiltInModels&) = delete;

  /// Writes the model `ground_plane` or `sun`; returns its folder, empty for other names.
  std::filesystem::path write(const std::string& name);

 private:
  std::filesystem::path folder_;  ///< empty: no model is written
};

/// SDF world as libsdformat reads it, with its models included.
class SdfWorld {
 public:
  /// Reads a file. Models are searched in `packages` by name, in folders of the file's parents, in folders `models` of
  /// these, and in the folders of GAZEBO_MODEL_PATH and GZ_SIM_RESOURCE_PATH. `model://ground_plane` and `model://sun`
  /// are known without a folder. Throws InputError with one line, "file:line: what", for the first error of
  /// libsdformat, for URIs of a network, and unless there is one world.
  SdfWorld(const std::filesystem::path& file, const std::map<std::string, std::filesystem::path>& packages);
  SdfWorld(const SdfWorld&) = delete;
  SdfWorld& operator=(const SdfWorld&) = delete;

  const sdf::World& world() const { return *root_.WorldByIndex(0); }
  const std::vector<Assumption>& rows() const { return rows_; }

  /// Returns the path of a mesh or a picture. `uri` as for Packages, or relative to the file that has the element.
  /// Throws InputError with file and line if the file does not exist.
  std::filesystem::path resolve(const std::string& uri, const sdf::ElementPtr& element) const;

  /// Throws InputError "file:line: <element>: what".
  [[noreturn]] void fail(const sdf::ElementPtr& element, const std::string& what) const;

 private:
  std::string find(const std::string& uri);
  std::optional<std::filesystem::path> find_model(const std::string& name) const;
  std::string built_in(const std::string& name);
  [[noreturn]] void fail(const sdf::Error& error, const sdf::ParserConfig& config) const;
  std::string text_of_unlocated(const sdf::Error& error, const sdf::ParserConfig& config,
                                std::optional<int>& line) const;

  std::filesystem::path file_;
  SdfSource source_;
  Packages packages_;
  BuiltInModels built_in_;
  sdf::Root root_;
  std::vector<Assumption> rows_;
};

Pose3 to_pose(const ignition::math::Pose3d& pose);

/// Returns the names of the element and of what it belongs to, "world default / model box / link body".
std::string path_of(const sdf::ElementPtr& element);

}  // namespace patrol::importer
