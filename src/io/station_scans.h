#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace patrol::io {

/// A panoramic scan that is kept for later ones to be compared with.
struct StationScan {
  std::string station;
  Pose3 T_map_scanner;               ///< of `scanner_level`, upright
  std::vector<ScannerPoint> points;  ///< in map
};

/// Writes <folder>/scans.json, which says where each was made, and <folder>/<station>.ply. The folder is made if need be.
void save_station_scans(const std::filesystem::path& folder, const std::vector<StationScan>& scans);

/// Throws InputError, naming file and place, when one is missing or wrong.
std::vector<StationScan> load_station_scans(const std::filesystem::path& folder);

/// The files that `load_station_scans` reads.
std::vector<std::filesystem::path> station_scan_files(const std::filesystem::path& folder);

}  // namespace patrol::io
