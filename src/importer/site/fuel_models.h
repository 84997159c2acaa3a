#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace patrol::importer {

/// Returns whether a URI names a file of a network.
bool is_of_network(std::string_view uri);

/// Model that a URI of a network names: `https://HOST/1.0/OWNER/models/NAME/VERSION/files/FILE`. Version and file are
/// optional.
struct FuelModel {
  std::string host;
  std::string owner;                ///< empty: the URI names none
  std::string name;                 ///< name of the model without codes such as %20
  std::string version = {};         ///< number; empty: the newest
  std::filesystem::path file = {};  ///< in the folder of the model; empty: the model itself
};

/// Returns the model of a URI; none if it is not of a network or names no model. Without a folder `models`, the last
/// part of the URI is the name.
std::optional<FuelModel> fuel_model(std::string_view uri);

/// Returns the folder of a model with its model.config: `folder`, or below it the one of the version. The newest one if
/// the model has no version.
std::optional<std::filesystem::path> version_folder(const std::filesystem::path& folder, const FuelModel& model);

/// Returns the folder of a model in the caches of Gazebo: those of GZ_FUEL_CACHE_PATH and IGN_FUEL_CACHE_PATH,
/// `~/.gz/fuel` and `~/.ignition/fuel`. Names are compared without case.
std::optional<std::filesystem::path> find_in_fuel_cache(const FuelModel& model);

/// Returns a folder below the home folder of the user; none if HOME is not set.
std::optional<std::filesystem::path> folder_at_home(const std::string& path);

}  // namespace patrol::importer
