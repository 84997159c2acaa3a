#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "importer/packages.h"

namespace patrol::importer {

constexpr std::string_view kModelScheme = "model://";

/// Returns whether a URI names a file of a network.
bool is_of_network(std::string_view uri);

/// Folders of the models that an SDF world includes.
class SdfModels {
 public:
  /// Models are searched in `packages` by name, in folders of the world's parents, in folders `models` of these, and in
  /// the folders of GAZEBO_MODEL_PATH and GZ_SIM_RESOURCE_PATH.
  SdfModels(const std::filesystem::path& world, const std::map<std::string, std::filesystem::path>& packages);

  const Packages& packages() const { return packages_; }

  /// Returns the folder of a model.
  std::optional<std::filesystem::path> find(const std::string& name) const;

  /// Returns the path of `model://NAME`, `model://NAME/FILE`, `file://FILE`, or a file relative to `folder` or to that
  /// of the world. It need not exist.
  std::optional<std::filesystem::path> find_uri(const std::string& uri, const std::filesystem::path& folder) const;

 private:
  std::filesystem::path world_;
  Packages packages_;
};

/// Returns the name in "model://NAME/FILE".
std::string model_name_of(std::string_view uri);

/// Returns the text of an error about a model that is not found.
std::string unknown_model(const std::string& name);

/// Returns the SDF file in the folder of a model, by its model.config: the one of the latest version that libsdformat
/// reads, or of the first later one. Throws InputError without file and line if there is none.
std::filesystem::path sdf_file_of_model(const std::filesystem::path& folder);

}  // namespace patrol::importer
