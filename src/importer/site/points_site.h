#pragma once

#include <functional>
#include <string>

#include "importer/site/site_import.h"
#include "io/points/point_reading.h"

namespace patrol::importer {

/// Reads panoramic scans of a folder (io/points/station_scans.h) or an E57 file and reconstructs the surfaces: each
/// scan as an image of ranges, without outliers and moving objects, and without surfaces that another scan measured
/// with closer beams. An E57 file whose points were not seen from the poses of its scans is a point cloud. Throws
/// InputError if the input is invalid or has no surface.
ImportedSite read_scans_site(const SiteImportOptions& options);

/// Reads a point cloud without scanner positions, PLY or PCD, and reconstructs the surfaces by an octree of planes.
/// Throws InputError if the file is invalid or its points form no surface.
ImportedSite read_cloud_site(const SiteImportOptions& options);

/// Returns the site of scans, which are consumed. `source`: file or name of the scans, for reports and errors.
ImportedSite site_of_scans(io::RelativeScans scans, const std::string& source, const SiteImportOptions& options);

/// Returns the site of a point cloud, which is consumed. `source`: as for scans.
ImportedSite site_of_cloud(io::RelativePoints cloud, const std::string& source, const SiteImportOptions& options);

}  // namespace patrol::importer
