#pragma once

#include <filesystem>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds in PCD, the format of the Point Cloud Library, version 0.7.
namespace patrol::io {

struct PointShift;  // io/points/point_collector.h

/// Writes binary PCD: x, y, z in meters and intensity, as floats; one row, viewpoint at the origin.
void save_pcd(const std::filesystem::path& file, const std::vector<ScannerPoint>& points);

/// Reads the fields x, y, z and intensity (0 if missing), of any type; DATA ascii, binary or binary_compressed. Points
/// remain in the frame of the file; VIEWPOINT is ignored. Throws InputError for an invalid file. Memory is bounded by a
/// multiple of the file size, with compressed data by 200 times.
std::vector<ScannerPoint> load_pcd(const std::filesystem::path& file);

/// Reads points as `load_pcd`, shifted to an origin, and leaves out points that are not finite.
std::vector<ScannerPoint> load_shifted_pcd(const std::filesystem::path& file, PointShift& shift);

}  // namespace patrol::io
