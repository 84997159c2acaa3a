#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace patrol::io {

/// Stored panoramic scan, a reference for later scans of the station.
struct StationScan {
  std::string station;
  Pose3 T_map_scanner;               ///< pose of the upright frame `scanner_level`
  std::vector<ScannerPoint> points;  ///< points in map
};

/// Writes <folder>/scans.json with the scan poses and <folder>/<station>.ply. Creates the folder if necessary.
void save_station_scans(const std::filesystem::path& folder, const std::vector<StationScan>& scans);

/// Reads stored scans. Throws InputError with file and JSON path if one is missing or invalid.
std::vector<StationScan> load_station_scans(const std::filesystem::path& folder);

/// Returns the files read by `load_station_scans`.
std::vector<std::filesystem::path> station_scan_files(const std::filesystem::path& folder);

}  // namespace patrol::io
