#pragma once

#include "importer/site/site_import.h"
#include "importer/site/wall_segments.h"

namespace patrol::importer {

/// Reads a floor plan of map_server (YAML and image) and extrudes its occupied cells to walls of `wall_height_m`. Gaps
/// of the plan stay open; unknown cells are empty. The map itself becomes the floor plan of the site, and its frame is
/// `site`. Throws InputError if the file is invalid or has no occupied cell.
ImportedSite read_plan_site(const SiteImportOptions& options);

/// Returns the site of a floor plan of which a lidar saw the walls: the faces of `walls` instead of the cells that they
/// cover.
ImportedSite site_of_walls(const OccupancyGrid& plan, const WallFitter& walls, const SiteImportOptions& options);

}  // namespace patrol::importer
