#pragma once

#include <optional>

#include "importer/site/site_import.h"

namespace patrol::app {

/// Maps a recorded lidar log as `patrol slam` does, fits the walls to the hits, and returns the site of the mapped
/// building: `site` is the pose of the body at the first scan. Without stations in the options, the mission is the
/// recorded path. None if interrupted. Throws InputError.
std::optional<importer::ImportedSite> import_log_site(const importer::SiteImportOptions& options);

}  // namespace patrol::app
