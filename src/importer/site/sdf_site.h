#pragma once

#include "importer/site/site_import.h"

namespace patrol::importer {

/// Reads an SDF world by libsdformat as a site: visuals are seen by cameras and lidars, collisions have contact (meshes
/// that of `contact_geometry`). All models are static. Links without a visual are seen by lidars as their collisions.
/// The first <state> replaces the poses of its models and links, as in Gazebo Classic. Uses `packages`,
/// `without`, `xacro_arguments`, `python`, `start` and `contact_cell_m`. Throws InputError "file:line: <element>: what"
/// if the file is invalid or has elements that are not supported.
ImportedSite read_sdf_site(const SiteImportOptions& options);

}  // namespace patrol::importer
