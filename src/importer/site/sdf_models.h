#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importer/packages.h"
#include "importer/site/fuel_models.h"

namespace patrol::importer {

constexpr std::string_view kModelScheme = "model://";

/// Folders of the models that an SDF world includes.
class SdfModels {
 public:
  /// Models are searched in `packages` by name, in folders of the world's parents, in folders `models` of these, in the
  /// folders of GAZEBO_MODEL_PATH and GZ_SIM_RESOURCE_PATH, and in `~/.gazebo/models`.
  SdfModels(const std::filesystem::path& world, const std::map<std::string, std::filesystem::path>& packages);

  const Packages& packages() const { return packages_; }

  /// Returns the folder of a model.
  std::optional<std::filesystem::path> find(const std::string& name) const;

  /// Returns the folder of a model of a network: by its name in any case in `packages`, by its name as for other
  /// models, or in a cache of Gazebo.
  std::optional<std::filesystem::path> find(const FuelModel& model) const;

  /// Returns the path of `model://NAME`, `model://NAME/FILE`, a model of a network or its file, `file://FILE`, or a
  /// file relative to `folder` or to that of the world. A file that is not there is searched in the folders of
  /// `packages`, in the three folders above both, and in those of GAZEBO_RESOURCE_PATH and the variables of models. It
  /// need not exist.
  std::optional<std::filesystem::path> find_uri(const std::string& uri, const std::filesystem::path& folder) const;

 private:
  std::filesystem::path find_file(const std::string& uri, const std::filesystem::path& folder) const;

  std::filesystem::path world_;
  Packages packages_;
  std::map<std::string, std::filesystem::path> lower_case_;  ///< given packages, by name in lower case
};

/// Returns the name of the model in a URI of a model or of a network; empty if there is none.
std::string name_in(const std::string& uri);

/// Returns the text of an error about a model that is not found. `uri`: of a model or of a network.
std::string unknown_model(const std::string& uri);

/// Returns the text of an error about several models that are not found.
std::string unknown_models(const std::vector<std::string>& uris);

/// Returns the text of an error about a file that is not found.
std::string unknown_file(const std::string& uri);

/// Returns the SDF file in the folder of a model, by its model.config: the one of the latest version that libsdformat
/// reads, or of the first later one. Throws InputError without file and line if there is none.
std::filesystem::path sdf_file_of_model(const std::filesystem::path& folder);

}  // namespace patrol::importer
