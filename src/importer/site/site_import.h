#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Options of `patrol import site`. Each kind of file uses those that its reader names.
struct SiteImportOptions {
  std::filesystem::path file;
  std::string name;            ///< of the site, its folder and its files
  double wall_height_m = 2.5;  ///< floor plans: height of the walls
  double scale = 0.0;          ///< meshes and points: meters per unit of the file; 0: by rule
  std::string up = {};         ///< meshes and points: axis of the file that points up, y or z; empty: by rule
  std::optional<Eigen::Vector2d> start = {};  ///< meshes: point of the site on the ground; none: by rule
  double contact_cell_m = 0.05;               ///< meshes: cell of the contact geometry
  std::map<std::string, std::filesystem::path> packages = {};  ///< SDF: folders of models, by name
};

/// Reads a site file of any known kind, chosen by its extension. Throws InputError with one line, "file:line: element:
/// what", or with the known extensions.
ImportedSite import_site(const SiteImportOptions& options);

}  // namespace patrol::importer
