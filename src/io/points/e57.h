#pragma once

#include <filesystem>

#include "io/points/point_reading.h"

/// Scans of terrestrial laser scanners in E57 (ASTM E2807-11, Standard Specification for 3D Imaging Data Exchange).
namespace patrol::io {

/// Scans of an E57 file, relative to one origin.
struct E57Scans {
  RelativeScans scans;       ///< stations "scan_1", "scan_2"; points in the frame of the file minus the origin
  bool has_scanners = true;  ///< false: a scan has no pose, no spherical coordinates and no rows and columns
  double step = 0.0;         ///< largest distance of neighboring coordinates of floats of 32 bits; 0 if there are none
};

/// Reads all scans of a file with their poses, points and intensities (0 if there are none). Leaves out points that are
/// marked as invalid or are not finite. The origin follows the rule of `load_points`. Throws InputError with the
/// element of the XML section for an invalid file.
E57Scans load_e57(const std::filesystem::path& file, double unit_m = 1.0);

/// Returns the points of all scans as one cloud.
RelativePoints joined_points(E57Scans scans);

}  // namespace patrol::io
